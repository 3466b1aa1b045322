// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// ContourOptions::exact_vertices: what is done with surfaces of the linear grid.
#pragma once

#include <span>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>

namespace isotet::session {

/// Moves the vertices of surfaces of curved cells to where the quadratic field has the isovalue, makes their normals, and
/// drops what the options did not ask for.
///
/// `linear`   null where all cells are linear: nothing moves
/// `input`    on the linear grid
Result<void> move_vertices(const LinearGrid* linear, const ContourInput& input, const ContourOptions& options,
                           std::span<const double> isovalues, std::vector<Extraction>& surfaces, const Run& run);

} // namespace isotet::session
