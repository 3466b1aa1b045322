// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/opacity.hpp>
#include <isotet/picture.hpp>
#include <isotet/scene.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// A colour and what it means.
struct LegendEntry {
    Color color;
    std::string text;
};

/// The axes of the world as small arrows, and how long a round number is in the picture.
///
/// `camera`   of the scene's picture
/// `bar`      a scale bar: lengths are right in a parallel picture, and in a perspective one at the camera's target
/// `unit`     of coordinates, written behind the bar's number
struct Orientation {
    Camera camera;
    bool bar = false;
    std::string unit;
};

/// What is written beside a picture: at the right a colour scale with ticks at round numbers, or a legend, or both,
/// under a title, and the axes; below a caption and a scale bar. Without scale and legend the axes stand in the lower left
/// corner of the scene. Text is UTF-8; a font is part of isotet, with Latin and Greek letters, and what it
/// lacks is a box.
struct Annotation {
    std::string title;
    std::optional<ColorScale> scale;
    OpacityCurve opacity = {}; ///< of a volume, a line over the scale: transparent at its left edge, the most opaque at
                               ///< its right; without points: none
    std::string no_data; ///< what the scale's colour for no data means; empty: it is not shown
    std::vector<LegendEntry> legend;
    std::string caption; ///< cut off with an ellipsis where it is too long
    std::optional<Orientation> orientation;

    bool empty() const noexcept { return !scale && legend.empty() && caption.empty() && !orientation; }
};

/// How many letters of a text the font lacks, each of which is drawn as a box. Bytes that are not UTF-8 count, too.
/// Errors   internal when the font cannot be opened
ISOTET_API Result<std::size_t> count_missing_letters(std::string_view text);

struct PictureSize {
    std::uint32_t width = 0, height = 0;
};

/// What an annotation leaves, in a picture of `whole`, for what is drawn; nothing when that would be less than half of
/// its width or height: then the picture is too small for text.
/// Errors   internal when the font cannot be opened
ISOTET_API Result<std::optional<PictureSize>> room_beside(const Annotation& annotation, PictureSize whole);

/// A picture of `whole`, with a scene of the size that room_beside() says in its upper left corner, and the annotation
/// beside it: dark on light backgrounds, light on dark ones. An empty background stays empty.
///
/// Guarantees   the same bytes for the same version of FreeType
/// Errors       invalid_argument when the scene has another size; internal when the font cannot be opened
ISOTET_API Result<Picture> annotate(const Picture& scene, const Annotation& annotation, PictureSize whole,
                                    const Color& background);

} // namespace isotet
