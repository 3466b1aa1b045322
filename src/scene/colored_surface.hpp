// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces that carry the field which colours them.
#pragma once

#include <isotet/isosurface_scene.hpp>
#include <isotet/progress.hpp>

namespace isotet::scene {

/// Gives a boundary_of() a grid the values of a field of that grid, as its first field of points or cells.
/// Errors   invalid_argument when the field does not fit the grid; as split()
Result<void> color_boundary(Surface& boundary, const Grid& grid, const ColorField& field, const Run& run);

/// The first field of points or cells, as `field` is one, with its scale.
SurfaceColors carried_colors(const Surface& surface, const ColorField& field);

} // namespace isotet::scene
