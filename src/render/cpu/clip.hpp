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

/// Triangle `triangle` of a sheet; no points where nothing of it is in view.
FixedPolygon polygon_of(const Sheet& sheet, std::size_t triangle, const Sight& sight);

} // namespace isotet::render
