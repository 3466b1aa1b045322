// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Curved cells by their corners: where the cells of a grid are, and which are smaller than others.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/grid.hpp>

namespace isotet::linear {

struct CornerCells {
    Grid grid;                          ///< the same points
    std::vector<std::uint64_t> sources; ///< the cell of each
};

/// Linear cells and polyhedra as they are, and curved cells that can be contoured as the linear cells of their corners; all
/// others are left out. Nothing is checked: cells that no grid can have are left out, too.
CornerCells corner_cells(const Grid& grid);

} // namespace isotet::linear
