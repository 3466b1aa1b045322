// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/write/write_names.hpp"

#include <cstddef>

#include <fmt/core.h>

namespace isotet::io {
namespace {

bool is_continuation(std::string_view text, std::size_t at) {
    return at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
}

/// Bytes of the UTF-8 character that starts here; 0 if none does (too long a form, a surrogate, beyond U+10FFFF).
std::size_t utf8_length(std::string_view text) {
    const auto first = static_cast<unsigned char>(text[0]);
    if (first < 0x80) return 1;
    const auto second = text.size() > 1 ? static_cast<unsigned char>(text[1]) : 0U;
    if (first >= 0xC2 && first <= 0xDF) return is_continuation(text, 1) ? 2 : 0;
    if (first >= 0xE0 && first <= 0xEF) {
        if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second > 0x9F)) return 0;
        return is_continuation(text, 1) && is_continuation(text, 2) ? 3 : 0;
    }
    if (first >= 0xF0 && first <= 0xF4) {
        if ((first == 0xF0 && second < 0x90) || (first == 0xF4 && second > 0x8F)) return 0;
        return is_continuation(text, 1) && is_continuation(text, 2) && is_continuation(text, 3) ? 4 : 0;
    }
    return 0;
}

std::string percent(char byte) { return fmt::format("%{:02X}", static_cast<unsigned char>(byte)); }

/// U+0080 to U+009F are control characters, U+FFFE and U+FFFF are none that XML allows.
bool is_forbidden(std::string_view character) {
    const auto first = static_cast<unsigned char>(character[0]);
    if (character.size() == 1) return first < 0x20 || first == 0x7F;
    if (character.size() == 2) return first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
    return character == "\xEF\xBF\xBE" || character == "\xEF\xBF\xBF";
}

} // namespace

std::string printable_name(std::string_view name) {
    std::string result;
    while (!name.empty()) {
        const std::size_t length = utf8_length(name);
        const auto character = name.substr(0, length == 0 ? 1 : length);
        if (length == 0 || is_forbidden(character)) {
            for (const char byte : character) result += percent(byte);
        } else {
            result += character;
        }
        name.remove_prefix(character.size());
    }
    return result;
}

std::string xml_name(std::string_view name) {
    std::string result;
    for (const char character : printable_name(name)) {
        switch (character) {
        case '&': result += "&amp;"; break;
        case '<': result += "&lt;"; break;
        case '>': result += "&gt;"; break;
        case '"': result += "&quot;"; break;
        case '\'': result += "&apos;"; break;
        default: result += character;
        }
    }
    return result;
}

std::string legacy_vtk_name(std::string_view name) {
    std::string result;
    for (const char character : name) {
        if (character <= ' ' || character > '~' || character == '"' || character == '%') result += percent(character);
        else result += character;
    }
    return result;
}

std::string ply_name(std::string_view name) {
    std::string result;
    for (const char character : name) result += character > ' ' && character <= '~' ? character : '_';
    return result;
}

std::string gocad_name(std::string_view name) {
    std::string result;
    for (const char character : printable_name(name)) {
        if (character == '"') result += percent(character);
        else result += character;
    }
    return result;
}

std::string take_name(std::string_view name, std::set<std::string, std::less<>>& taken) {
    const std::string wanted(name.empty() ? std::string_view("field") : name);
    std::string candidate = wanted;
    for (int number = 2; !taken.insert(candidate).second; ++number) candidate = fmt::format("{}_{}", wanted, number);
    return candidate;
}

} // namespace isotet::io
