// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <fmt/core.h>

#include "io/files/escape.hpp"

namespace isotet::io {

std::size_t printable_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    const std::size_t length = first >= 0x20 && first < 0x7F   ? 1
                               : first >= 0xC2 && first < 0xE0 ? 2
                               : first >= 0xE0 && first < 0xF0 ? 3
                               : first >= 0xF0 && first < 0xF5 ? 4
                                                               : 0;
    if (length == 0 || length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xC0) != 0x80) return 0;
    if (length == 2 && first == 0xC2 && byte(1) < 0xA0) return 0; // U+0080 to U+009F
    return length;
}

std::string escaped(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const auto byte = static_cast<unsigned char>(text[0]);
        std::size_t length = 1;
        if (byte == '\n' || byte == '\r') {
            if (!result.empty() && result.back() != ' ') result += ' ';
        } else if (length = printable_length(text); length == 0) {
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
