// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/amr/lattice.hpp"

namespace isotet::io::amr {

/// One byte a cell of a box: nonzero where it is left out.
using Marks = std::vector<std::uint8_t>;

/// Marks cells under finer ones, and those that an earlier box of their level has, too.
///
/// `marks`   of each box, level by level: what the file leaves out (ghost cells, blanked ones), or empty. Such cells
///           cover no others
/// Errors    invalid_data: a cell that finer ones cover in part, a box that reaches out of those of the coarser level;
///           out_of_memory; cancelled
/// Cost      a few passes over the cells, 8 bytes a cell of a level
Result<void> mark_covered(const Hierarchy& hierarchy, const Lattice& lattice, std::vector<Marks>& marks,
                          const Progress& progress);

} // namespace isotet::io::amr
