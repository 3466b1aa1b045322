// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "text.hpp"

#include <cstdint>

#include <fmt/format.h>

namespace isotet::cli {

namespace {

struct Character {
    char32_t code = 0;
    std::size_t bytes = 0; ///< 0: not UTF-8
};

/// The character at the start of `text`; overlong forms and surrogates are not UTF-8.
Character first_character(std::string_view text) noexcept {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const std::uint8_t lead = byte(0);
    if (lead < 0x80) return {lead, 1};
    const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes) return {};
    char32_t code = lead & (0x7FU >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xC0U) != 0x80U) return {};
        code = (code << 6) | (byte(i) & 0x3FU);
    }
    constexpr char32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
    if (code < smallest[bytes] || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return {};
    return {code, bytes};
}

bool misleads_a_terminal(char32_t code) noexcept {
    return (code >= 0x7F && code <= 0x9F) || (code >= 0x2028 && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069) ||
           code == 0x200E || code == 0x200F || code == 0x061C;
}

template <class Append>
std::string rewritten(std::string_view text, const Append& append_character) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const Character character = first_character(text);
        if (character.bytes == 0) {
            result += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(text.front()));
            text.remove_prefix(1);
        } else {
            append_character(result, character, text.substr(0, character.bytes));
            text.remove_prefix(character.bytes);
        }
    }
    return result;
}

} // namespace

std::string printable(std::string_view text) {
    return rewritten(text, [](std::string& result, Character character, std::string_view bytes) {
        if (character.code == '\n') result += "\\n";
        else if (character.code == '\t') result += "\\t";
        else if (character.code < 0x20 || character.code == 0x7F)
            result += fmt::format("\\x{:02x}", std::uint32_t{character.code});
        else if (misleads_a_terminal(character.code))
            result += fmt::format("\\u{{{:04x}}}", std::uint32_t{character.code});
        else result += bytes;
    });
}

std::string valid_utf8(std::string_view text) {
    return rewritten(text, [](std::string& result, Character, std::string_view bytes) { result += bytes; });
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
