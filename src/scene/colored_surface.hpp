// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces that carry the field which colours them.
#pragma once

#include <isotet/export.hpp>
#include <isotet/isosurface_scene.hpp>
#include <isotet/progress.hpp>

namespace isotet::scene {

/// Gives a boundary_of() a grid the values of a field of that grid, as its first field of points or cells.
/// Errors   invalid_argument when the field does not fit the grid; as split()
Result<void> color_boundary(Surface& boundary, const Grid& grid, const ColorField& field, const Run& run);

/// normal . p of each point, float64.
ISOTET_API Array heights_over(const Array& points, const Plane& plane);

/// The cut through a grid along a plane; with `field`, if there is one, as its first field of points or cells.
ISOTET_API Result<Surface> slice_of(const Grid& grid, const Plane& plane, const ColorField* field, const Run& run);

/// The first field of points or cells, as `field` is one, with its scale.
SurfaceColors carried_colors(const Surface& surface, const ColorField& field);

} // namespace isotet::scene
