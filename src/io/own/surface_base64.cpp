// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/own/surface_base64.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "io/own/text_scanner.hpp"

namespace isotet::io {
namespace {

constexpr std::uint8_t no_digit = 255;

constexpr std::array<std::uint8_t, 256> make_digits() {
    std::array<std::uint8_t, 256> digits{};
    digits.fill(no_digit);
    constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (std::size_t i = 0; i < alphabet.size(); ++i) {
        digits[static_cast<unsigned char>(alphabet[i])] = static_cast<std::uint8_t>(i);
    }
    return digits;
}
constexpr auto digit_of = make_digits();

} // namespace

std::optional<std::string> decode_base64(std::string_view text, std::size_t most) {
    std::string result;
    result.reserve(std::min(most, text.size() / 4 * 3 + 3));
    std::uint32_t group = 0;
    int count = 0, padding = 0;
    for (const char c : text) {
        if (result.size() >= most) break;
        if (is_space(c)) continue;
        const auto digit = digit_of[static_cast<unsigned char>(c)];
        if (c == '=') {
            if (count < 2) return std::nullopt;
            ++padding;
        } else if (digit == no_digit) {
            break;
        } else if (padding) {
            return std::nullopt;
        }
        group = (group << 6U) | (c == '=' ? 0U : digit);
        if (++count < 4) continue;
        for (int i = 0; i < 3 - padding; ++i)
            result += static_cast<char>((group >> (16U - 8U * static_cast<unsigned>(i))) & 0xFFU);
        group = 0;
        count = padding = 0;
    }
    if (count != 0 && result.size() < most) return std::nullopt;
    result.resize(std::min(result.size(), most));
    return result;
}

} // namespace isotet::io
