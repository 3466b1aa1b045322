// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>

namespace isotet {

/// A colour as pictures have it (sRGB), each part from 0 to 1; opacity apart from the colour (not multiplied).
struct Color {
    float red = 0, green = 0, blue = 0, opacity = 1;

    friend bool operator==(const Color&, const Color&) = default;
};

/// "#1f77b4", "#1f77b480" (with opacity), "white", "black", "transparent" and a few more names; nothing for other text.
ISOTET_API std::optional<Color> parse_color(std::string_view text) noexcept;

/// Pixels, row by row from the top.
///
/// `pixels`   width x height, each red, green, blue and opacity (not multiplied)
struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::array<std::uint8_t, 4>> pixels;

    const std::array<std::uint8_t, 4>& at(std::uint32_t x, std::uint32_t y) const noexcept {
        return pixels[std::size_t{y} * width + x];
    }

    /// No pixel lets anything through.
    bool opaque() const noexcept {
        return std::ranges::all_of(pixels, [](const auto& pixel) { return pixel[3] == 255; });
    }
};

} // namespace isotet
