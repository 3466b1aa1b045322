// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Axes and scale bars beside pictures.
#pragma once

#include <isotet/render.hpp>

#include "render/text.hpp"

namespace isotet::render {

/// A line with round ends, `width` pixels wide, over a picture.
void paint_line(Picture& picture, std::array<double, 2> from, std::array<double, 2> to, double width, const Color& color);

/// The axes as arrows of at most `radius` pixels around a place, with letters in `ink`.
void paint_axes(Picture& picture, double x, double y, double radius, const Camera& camera, const TextPainter& text,
                const Color& ink);

/// A round length that is at most `longest` pixels long in a scene of `height` pixels, and its text.
struct ScaleBar {
    double pixels = 0;
    std::string label;
};
ScaleBar scale_bar(const Orientation& orientation, double height, double longest);

} // namespace isotet::render
