// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Vertices on the edges of linear tets, moved to where the quadratic field has the isovalue.
#pragma once

#include <span>

#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet::linear {

/// Moves each vertex along its edge, which may be curved, to the root of the quadratic field there, and point fields with
/// it. The surface stays welded: all tets at an edge have the same root.
///
/// `linear`    of curved cells
/// `values`    one scalar a point of linear.grid: the field that was contoured
/// `carried`   one array a point field of the surface, likewise
/// `surface`   with edge_ends, edge_weights and source_cells in numbers of linear.grid; normals stay as they are
/// Cost        O(V + F); 8 bytes a vertex
/// Errors      cancelled
Result<void> move_to_roots(const LinearGrid& linear, const Array& values, std::span<const Field> carried,
                           double isovalue, Surface& surface, const Progress& progress);

} // namespace isotet::linear
