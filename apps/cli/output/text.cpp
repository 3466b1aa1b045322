// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "output/text.hpp"

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

bool is_letter_or_digit(char c) noexcept {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// Of what stands in quotes from `begin` on, with these; 0: nothing does. Apostrophes are no quotes.
std::size_t quoted_length(std::string_view sentence, std::size_t begin) noexcept {
    constexpr std::string_view before = " (,:;/\n";
    if (sentence[begin] != '\'' || (begin > 0 && before.find(sentence[begin - 1]) == before.npos)) return 0;
    for (std::size_t end = sentence.find('\'', begin + 1); end != sentence.npos; end = sentence.find('\'', end + 1))
        if (end + 1 == sentence.size() || !is_letter_or_digit(sentence[end + 1])) return end + 1 - begin;
    return 0;
}

/// Of an option's name in backquotes at the beginning, with these; 0: there is none.
std::size_t option_length(std::string_view text) noexcept {
    if (!text.starts_with('`')) return 0;
    const std::size_t end = text.find_first_not_of("abcdefghijklmnopqrstuvwxyz_", 1);
    return end != text.npos && end > 1 && text[end] == '`' ? end + 1 : 0;
}

} // namespace

std::string printable(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const auto [code, bytes, valid] = first_utf8_character(text);
        if (!valid) result += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(text.front()));
        else if (code == '\n') result += "\\n";
        else if (code == '\t') result += "\\t";
        else if (code < 0x20 || code == 0x7F) result += fmt::format("\\x{:02x}", std::uint32_t{code});
        else if (misleads_a_terminal(code)) result += fmt::format("\\u{{{:04x}}}", std::uint32_t{code});
        else result += text.substr(0, bytes);
        text.remove_prefix(bytes);
    }
    return result;
}

std::string with_options(std::string_view sentence) {
    std::string result;
    for (std::size_t at = 0; at < sentence.size();) {
        if (const std::size_t quoted = quoted_length(sentence, at); quoted > 0) {
            result += sentence.substr(at, quoted);
            at += quoted;
        } else if (const std::size_t named = option_length(sentence.substr(at)); named > 0) {
            std::string option(sentence.substr(at + 1, named - 2));
            std::ranges::replace(option, '_', '-');
            result += "--" + option;
            at += named;
        } else result += sentence[at++];
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
