// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Curved cells by their corners: where the cells of a grid are, and which are smaller than others.
#pragma once

#include <isotet/grid.hpp>

namespace isotet::linear {

/// The same points, linear cells, and curved ones that can be contoured as the linear cells of their corners; all others
/// are left out. Nothing is checked: cells that no grid can have are left out, too.
Grid corner_cells(const Grid& grid);

} // namespace isotet::linear
