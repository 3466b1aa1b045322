// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/amr/lattice.hpp"
#include "io/amr/shown_cells.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::amr {

/// Gives the pieces a point field for each cell field that has none of its name.
///
/// A point has the mean of the shown cells around it, weighted by one over their lengths: so where all eight are there,
/// of any levels, a linear field stays what it is. A point that hangs on an edge or a face of a larger cell has that
/// cell's value there, linear or bilinear between its corners: from both levels the same. Cells whose value is NaN are
/// left out. float32 stays, all other types become float64.
///
/// `pieces`   one a box, level by level
/// Errors     cancelled
/// Cost       about 100 bytes a cell, and the fields
Result<void> add_point_values(const Hierarchy& hierarchy, const Lattice& lattice, const std::vector<Marks>& marks,
                              std::vector<Piece>& pieces, const Progress& progress);

} // namespace isotet::io::amr
