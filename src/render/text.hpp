// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Text in pictures, in the font that isotet brings along (font/): no font of the machine is looked for.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include <isotet/picture.hpp>
#include <isotet/result.hpp>

namespace isotet::render {

/// The font at one size.
///
/// Text is UTF-8; what is not, and what the font lacks, is a box. No line breaks.
class TextPainter {
public:
    /// `size`   pixels from a baseline to the next, about; at least 4
    /// Errors   internal when FreeType cannot open the font
    static Result<std::unique_ptr<TextPainter>> open(double size);
    ~TextPainter();
    TextPainter(const TextPainter&) = delete;
    TextPainter& operator=(const TextPainter&) = delete;

    double width(std::string_view text) const;              ///< pixels
    std::size_t count_missing(std::string_view text) const; ///< letters that are boxes
    double ascent() const noexcept;                         ///< of capitals and digits above the baseline

    /// Paints text over a picture, its baseline beginning at (x, y); what does not fit is cut off.
    void paint(Picture& picture, double x, double y, std::string_view text, const Color& color) const;

private:
    struct Data;
    explicit TextPainter(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

/// Puts a colour over a pixel: `coverage`, 0 to 1, times its opacity.
void blend(std::array<std::uint8_t, 4>& pixel, const Color& color, float coverage);

} // namespace isotet::render
