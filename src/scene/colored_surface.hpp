// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces that carry the field which colours them.
#pragma once

#include <isotet/isosurface_scene.hpp>
#include <isotet/progress.hpp>

namespace isotet::scene {

/// Gives a boundary_of() a grid the values of a field of that grid, as its first field of points or cells.
/// Errors   invalid_argument when the field does not fit the grid; as split()
Result<void> color_boundary(Surface& boundary, const Grid& grid, const ColorField& field, const Run& run);

/// The same of a field of points, without the grid's cells.
void color_by_points(Surface& boundary, const ColorField& field);

/// The same of a field of cells, with boundary_cells().
void color_by_cells(Surface& boundary, const std::vector<std::uint64_t>& cells, const ColorField& field);

/// Of each triangle of a boundary the lowest cell that has it.
Result<std::vector<std::uint64_t>> boundary_cells(const Surface& boundary, const Grid& grid, const Run& run);

/// The first field of points or cells, as `field` is one, with its scale.
SurfaceColors carried_colors(const Surface& surface, const ColorField& field);

} // namespace isotet::scene
