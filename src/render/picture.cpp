// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/picture.hpp>

#include <algorithm>

namespace isotet {

namespace {

struct NamedColor {
    std::string_view name;
    Color color;
};
constexpr std::array<NamedColor, 8> named_colors{{{"white", {1, 1, 1, 1}},
                                                  {"black", {0, 0, 0, 1}},
                                                  {"transparent", {0, 0, 0, 0}},
                                                  {"gray", {0.5F, 0.5F, 0.5F, 1}},
                                                  {"red", {0.84F, 0.15F, 0.16F, 1}},
                                                  {"green", {0.17F, 0.63F, 0.17F, 1}},
                                                  {"blue", {0.12F, 0.47F, 0.71F, 1}},
                                                  {"orange", {1, 0.50F, 0.05F, 1}}}};

std::optional<int> digit_of(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return {};
}

} // namespace

std::optional<Color> parse_color(std::string_view text) noexcept {
    for (const NamedColor& one : named_colors)
        if (one.name == text) return one.color;
    if ((text.size() != 7 && text.size() != 9) || text.front() != '#') return {};
    std::array<float, 4> parts{0, 0, 0, 1};
    for (std::size_t i = 0; 2 * i + 1 < text.size(); ++i) {
        const auto high = digit_of(text[2 * i + 1]), low = digit_of(text[2 * i + 2]);
        if (!high || !low) return {};
        parts[i] = static_cast<float>(16 * *high + *low) / 255;
    }
    return Color{parts[0], parts[1], parts[2], parts[3]};
}

} // namespace isotet
