// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Flat cells: shells, surfaces, results in two dimensions.
#pragma once

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet::core {

/// The flat cells as triangles, in the order of the cells, those with two equal corners left out; other cells are passed
/// over. A quadrilateral is split from its first corner, a polygon as a fan; a quadratic cell at its nodes, one of a higher
/// degree is taken by its corners. Positions, edge_ends as boundary_of(); source_cells.
///
/// Errors   invalid_data: as survey(), too many points for a surface; cancelled
Result<Surface> sheet_of(const Grid& grid, const Progress& progress);

} // namespace isotet::core
