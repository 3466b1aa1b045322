// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "bench/protocol.hpp"

#include <array>
#include <charconv>
#include <iostream>
#include <stdexcept>

#include "bench/memory_use.hpp"

namespace isotet::bench {

namespace {

Words split_at_tabs(const std::string& line) {
    Words words;
    std::size_t begin = 0;
    for (std::size_t tab; (tab = line.find('\t', begin)) != std::string::npos; begin = tab + 1)
        words.push_back(line.substr(begin, tab - begin));
    words.push_back(line.substr(begin));
    return words;
}

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
    return out + "\"";
}

template <class Number>
std::string shortest(Number value) {
    std::array<char, 32> text;
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

template <class Number>
Number parsed(const Words& words, std::size_t index) {
    const std::string& text = word(words, index);
    Number value{};
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc{} || end != text.data() + text.size())
        throw std::invalid_argument(words[0] + ": '" + text + "' is not a number");
    return value;
}

Reply answer_with_peak(const std::function<Reply(const Words&)>& answer, Words words) {
    words.erase(words.begin());
    start_peak();
    const std::uint64_t before = resident_bytes();
    Reply reply = answer(words);
    const std::uint64_t peak = peak_bytes();
    return reply.count("peak_bytes", peak > before ? peak - before : 0);
}

} // namespace

Reply& Reply::add(const char* name, const std::string& value) {
    if (!fields_.empty()) fields_ += ", ";
    fields_ += quoted(name) + ": " + value;
    return *this;
}

Reply& Reply::number(const char* name, double value) { return add(name, shortest(value)); }
Reply& Reply::count(const char* name, std::uint64_t value) { return add(name, shortest(value)); }
Reply& Reply::text(const char* name, const std::string& value) { return add(name, quoted(value)); }

int serve(const std::function<Reply(const Words&)>& answer) {
    for (std::string line; std::getline(std::cin, line);) {
        Reply reply;
        try {
            const Words words = split_at_tabs(line);
            reply = words[0] == "peak" ? answer_with_peak(answer, words) : answer(words);
        } catch (const std::exception& error) {
            reply = Reply().text("error", error.what());
        }
        std::cout << reply.json() << std::endl;
    }
    return 0;
}

const std::string& word(const Words& words, std::size_t index) {
    if (index >= words.size())
        throw std::invalid_argument(words[0] + " needs " + std::to_string(index) + " arguments, but has " +
                                    std::to_string(words.size() - 1));
    return words[index];
}

double number(const Words& words, std::size_t index) { return parsed<double>(words, index); }
int whole_number(const Words& words, std::size_t index) { return parsed<int>(words, index); }

} // namespace isotet::bench
