// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

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

// Pictures in files; part of isotet::io.

/// Writes a PNG file, with an alpha channel only where the picture is not opaque. Written beside and renamed, as all
/// files.
///
/// Guarantees   the same bytes for the same picture (and version of libdeflate)
/// Errors       invalid_argument when the ending is not .png, or the picture has no pixels; file, cannot_write as
///              write_surface()
ISOTET_API Result<std::uint64_t> write_picture(const Picture& picture, const std::string& path);

/// Reads a PNG file of any kind as 8 bits a part.
///
/// Errors   file: not there; invalid_data: no PNG, broken, or of more than 32768 x 32768 pixels
ISOTET_API Result<Picture> read_picture(const std::string& path);

/// The share of pixels, 0 to 1, that differ visibly: in some part by more than `tolerance` of 255. Where nothing can be
/// seen in either picture, colours do not count.
///
/// Errors   invalid_argument when the pictures have different sizes
ISOTET_API Result<double> difference(const Picture& a, const Picture& b, int tolerance = 12);

/// Pictures one after another in one file, for ever: animated WebP, which browsers and slides show. The file is there
/// when finish() has written it; without that nothing is written. Moving is cheap.
class ISOTET_API Animation {
public:
    /// `path`                 ends in .webp
    /// `pictures_per_second`  above 0, at most 100
    /// Errors   invalid_argument
    static Result<Animation> create(const std::string& path, double pictures_per_second);

    Animation(Animation&&) noexcept;
    Animation& operator=(Animation&&) noexcept;
    ~Animation();

    /// Appends a picture; all have the size of the first. It is compressed with losses that are hard to see.
    ///
    /// Cost     what the compressed pictures take stays in memory until finish()
    /// Errors   invalid_argument when it has no pixels, more than 16383 in a row or column, or another size;
    ///          out_of_memory
    Result<void> add(const Picture& picture);

    /// Writes the file, beside and renamed as all files. Returns its bytes. Nothing can be added afterwards.
    ///
    /// Guarantees   the same bytes for the same pictures (and version of libwebp)
    /// Errors       invalid_argument when there is no picture; file, cannot_write as write_picture()
    Result<std::uint64_t> finish();

private:
    struct Encoder;
    explicit Animation(std::unique_ptr<Encoder> encoder);
    std::unique_ptr<Encoder> encoder_;
};

} // namespace isotet
