// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <fmt/core.h>

#include "io/files/escape.hpp"

namespace isotet::io {
namespace {

/// Bytes of the UTF-8 character at the start of `text`; 0 if there is none. (C1 controls, U+0080 to U+009F, are none.)
std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    const std::size_t length = first < 0x80                    ? 1
                               : first >= 0xC2 && first < 0xE0 ? 2
                               : first >= 0xE0 && first < 0xF0 ? 3
                               : first >= 0xF0 && first < 0xF5 ? 4
                                                               : 0;
    if (length == 0 || length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xC0) != 0x80) return 0;
    if (length == 2 && first == 0xC2 && byte(1) < 0xA0) return 0;
    return length;
}

} // namespace

std::string escaped(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const auto byte = static_cast<unsigned char>(text[0]);
        std::size_t length = 1;
        if (byte == '\n' || byte == '\r') {
            if (!result.empty() && result.back() != ' ') result += ' ';
        } else if (byte < 0x20 || byte == 0x7F || (length = utf8_length(text)) == 0) {
            length = 1;
            result += fmt::format("\\x{:02x}", byte);
        } else {
            result += text.substr(0, length);
        }
        text.remove_prefix(length);
    }
    while (!result.empty() && result.back() == ' ') result.pop_back();
    return result;
}

} // namespace isotet::io
