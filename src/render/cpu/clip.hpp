// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The parts of triangles that have a place in the picture.
#pragma once

#include <array>
#include <cstddef>

#include "render/cpu/sheet.hpp"

namespace isotet::render {

/// A convex polygon in the picture: a triangle, or what clipping left of one.
struct FixedPolygon {
    std::array<FixedPoint, 9> points;
    std::size_t count = 0;
};

/// A triangle of which some corner is out of view.
FixedPolygon clipped_polygon_of(const Sheet& sheet, std::size_t triangle, const Sight& sight);

/// Triangle `triangle` of a sheet; no points where nothing of it is in view.
inline FixedPolygon polygon_of(const Sheet& sheet, std::size_t triangle, const Sight& sight) {
    FixedPolygon polygon;
    polygon.count = 3;
    bool in_view = true;
    for (std::size_t i = 0; i < 3; ++i) {
        polygon.points[i] = sheet.fixed[sheet.triangles[3 * triangle + i]];
        in_view = in_view && polygon.points[i].x != out_of_view;
    }
    return in_view ? polygon : clipped_polygon_of(sheet, triangle, sight);
}

} // namespace isotet::render
