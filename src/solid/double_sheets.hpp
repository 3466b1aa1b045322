// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Double sheets of solids: triangles that lie back to back. They arise where a face of a cell, or a part of it, has the
// isovalue, and the solid is on both sides of it or on neither.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

#include "solid/assemble.hpp"

namespace isotet::solid {

/// Leaves double sheets out of a solid. On a flat quadrilateral the two sides may have different diagonals, or one side may
/// have one triangle and the other two: then one triangle is left, of the side with two.
///
/// `solid`    the triangles of the shells, then those of the cap
/// `others`   isosurfaces of cells that belong to other pieces: a triangle of the solid may lie on one of theirs
/// `points`   of the grid
/// Returns    the triangles that were left out, ascending
/// Cost       O(n log n) in the triangles with a tied vertex, 150 bytes each while it works, and 24 bytes a vertex
/// Errors     out_of_memory, cancelled
Result<std::vector<std::uint64_t>> leave_out_double_sheets(Surface& solid, std::span<const Shell> shells,
                                                           const Cap& cap, std::span<const Shell> others,
                                                           const Array& points, const Progress& progress);

} // namespace isotet::solid
