// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/result.hpp>

namespace isotet {

/// A colour as pictures have it (sRGB), each part from 0 to 1; opacity apart from the colour (not multiplied).
struct Color {
    float red = 0, green = 0, blue = 0, opacity = 1;

    friend bool operator==(const Color&, const Color&) = default;
};

/// "#1f77b4", "#1f77b480" (with opacity), "white", "black", "transparent" and a few more names; nothing for other text.
std::optional<Color> parse_color(std::string_view text) noexcept;

/// Pixels, row by row from the top.
///
/// `pixels`   width x height, each red, green, blue and opacity (not multiplied)
struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::array<std::uint8_t, 4>> pixels;

    const std::array<std::uint8_t, 4>& at(std::uint32_t x, std::uint32_t y) const noexcept {
        return pixels[std::size_t{y} * width + x];
    }
    bool opaque() const noexcept; ///< no pixel lets anything through
};

/// Writes a PNG file, with an alpha channel only where the picture is not opaque. Written beside and renamed, as all
/// files.
///
/// Guarantees   the same bytes for the same picture (and version of libpng and zlib)
/// Errors       invalid_argument when the ending is not .png, or the picture has no pixels; file, cannot_write as
///              write_surface()
Result<std::uint64_t> write_picture(const Picture& picture, const std::string& path);

} // namespace isotet
