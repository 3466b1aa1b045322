// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The points that cells use, and a grid without the others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>

#include "grid/cells.hpp"

namespace isotet::core {

/// Keeps the points that a cell uses, as a corner or in a face, in their order, and what belongs to them. A corner that is no
/// point stays none, so that the checks of the grid say so.
///
/// Returns   a byte a point of before, 1 where it was kept; empty: all were
ISOTET_API std::vector<std::uint8_t> keep_used_points(Grid& grid);

/// A byte a point: 1 where a cell for which `counts` is true has it as a corner. Corners must be points.
/// Threads   `counts` is called by several
ISOTET_API std::vector<std::uint8_t> points_of_cells(const CellReader& cells,
                                                     const std::function<bool(std::size_t cell)>& counts);

/// Sets the bytes of the points in faces of those polyhedra for which `counts` is true.
ISOTET_API void mark_points_of_faces(const Cells& cells, std::vector<std::uint8_t>& used,
                                     const std::function<bool(std::size_t cell)>& counts);

/// The tuples of `values` whose number `kept` marks; an empty array stays empty.
ISOTET_API Array kept_tuples(const Array& values, const std::vector<std::uint8_t>& kept);

} // namespace isotet::core
