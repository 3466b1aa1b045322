// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/text.hpp>

#include <algorithm>

#include <fmt/format.h>

namespace isotet {

std::string format_bytes(std::uint64_t bytes) {
    if (bytes < 1000) return fmt::format("{} B", bytes);
    auto value = static_cast<double>(bytes);
    const char* unit = "";
    for (const char* larger : {"kB", "MB", "GB", "TB"}) {
        value /= 1000;
        unit = larger;
        if (value < 999.95) break;
    }
    return fmt::format("{:.1f} {}", value, unit);
}

Utf8Character first_utf8_character(std::string_view text) noexcept {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
    const std::uint8_t lead = byte(0);
    if (lead < 0x80) return {lead, 1, true};
    const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
    if (lead < 0xC2 || lead > 0xF4 || text.size() < bytes) return {};
    char32_t code = lead & (0x7FU >> bytes);
    for (std::size_t i = 1; i < bytes; ++i) {
        if ((byte(i) & 0xC0U) != 0x80U) return {};
        code = (code << 6) | (byte(i) & 0x3FU);
    }
    constexpr char32_t smallest[] = {0, 0, 0x80, 0x800, 0x10000};
    if (code < smallest[bytes] || code > 0x10FFFF || (code >= 0xD800 && code <= 0xDFFF)) return {};
    return {code, bytes, true};
}

std::string valid_utf8(std::string_view text) {
    std::string result;
    result.reserve(text.size());
    while (!text.empty()) {
        const Utf8Character character = first_utf8_character(text);
        if (character.valid) result += text.substr(0, character.bytes);
        else result += fmt::format("\\x{:02x}", static_cast<std::uint8_t>(text.front()));
        text.remove_prefix(character.bytes);
    }
    return result;
}

bool comes_before(std::string_view a, std::string_view b) noexcept {
    const auto number_at = [](std::string_view text) {
        return text.substr(0, std::min(text.find_first_not_of("0123456789"), text.size()));
    };
    while (!a.empty() && !b.empty()) {
        std::string_view x = number_at(a), y = number_at(b);
        if (x.empty() || y.empty()) {
            if (a[0] != b[0]) return a[0] < b[0];
            x = a.substr(0, 1);
            y = b.substr(0, 1);
        }
        a.remove_prefix(x.size());
        b.remove_prefix(y.size());
        x.remove_prefix(std::min(x.find_first_not_of('0'), x.size() - 1));
        y.remove_prefix(std::min(y.find_first_not_of('0'), y.size() - 1));
        if (x != y) return x.size() != y.size() ? x.size() < y.size() : x < y;
    }
    return a.size() < b.size();
}

} // namespace isotet
