// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "text.hpp"

#include <algorithm>
#include <cstdint>

#include <fmt/format.h>

#include <isotet/text.hpp>

namespace isotet::cli {

namespace {

bool misleads_a_terminal(char32_t code) noexcept {
    return (code >= 0x7F && code <= 0x9F) || (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) ||
           code == 0x200E || code == 0x200F || code == 0x061C;
}

template <class Append>
std::string rewritten(std::string_view text, const Append& append_character) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const Utf8Character character = first_utf8_character(text);
        if (!character.valid) result += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(text.front()));
        else append_character(result, character.code, text.substr(0, character.bytes));
        text.remove_prefix(character.bytes);
    }
    return result;
}

} // namespace

std::string printable(std::string_view text) {
    return rewritten(text, [](std::string& result, char32_t code, std::string_view bytes) {
        if (code == '\n') result += "\\n";
        else if (code == '\t') result += "\\t";
        else if (code < 0x20 || code == 0x7F) result += fmt::format("\\x{:02x}", std::uint32_t{code});
        else if (misleads_a_terminal(code)) result += fmt::format("\\u{{{:04x}}}", std::uint32_t{code});
        else result += bytes;
    });
}

std::string valid_utf8(std::string_view text) {
    return rewritten(text, [](std::string& result, char32_t, std::string_view bytes) { result += bytes; });
}

std::string with_options(std::string_view sentence) {
    std::string result;
    while (!sentence.empty()) {
        const std::size_t name = sentence.find('`') + 1; // 0: none
        const std::size_t end = name == 0 ? name : sentence.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", name);
        const bool is_option = name > 0 && end != std::string_view::npos && end > name && sentence[end] == '`';
        if (!is_option) {
            const std::size_t copied = name == 0 ? sentence.size() : name;
            result += sentence.substr(0, copied);
            sentence.remove_prefix(copied);
            continue;
        }
        std::string option(sentence.substr(name, end - name));
        std::ranges::replace(option, '_', '-');
        result += sentence.substr(0, name - 1);
        result += "--";
        result += option;
        sentence.remove_prefix(end + 1);
    }
    return result;
}

std::size_t width_of(std::string_view printable_text) noexcept {
    std::size_t width = 0;
    for (const char c : printable_text) width += (static_cast<std::uint8_t>(c) & 0xC0U) != 0x80U;
    return width;
}

std::string wrapped(std::string_view paragraph, std::size_t columns, std::size_t indent) {
    std::string result;
    std::size_t column = indent; // the caller has already printed that much of the first line
    while (!paragraph.empty()) {
        const std::size_t space = paragraph.find(' ');
        const std::string_view word = paragraph.substr(0, space);
        paragraph.remove_prefix(space == std::string_view::npos ? paragraph.size() : space + 1);
        if (word.empty()) continue;
        if (column > indent && column + 1 + width_of(word) > columns) {
            result += '\n';
            result.append(indent, ' ');
            column = indent;
        } else if (column > indent) {
            result += ' ';
            ++column;
        }
        result += word;
        column += width_of(word);
    }
    return result;
}

} // namespace isotet::cli
