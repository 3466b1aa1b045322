// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Bisected tets of all blocks as one grid: points that several quadratic tets have become one.
#pragma once

#include <vector>

#include <isotet/linear_cells.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "linear/curved/bisection.hpp"
#include "linear/curved/quadratic.hpp"

namespace isotet::linear {

/// Sets cells, source_cells and refined, not the points. Takes blocks and quadratic tets apart; `points` is how many the
/// grid has so far.
///
/// Guarantees   the same numbers for any thread count and any blocks
/// Errors       out_of_memory; cancelled
Result<LinearGrid> welded(std::vector<Bisected>& blocks, QuadraticTets& tets, std::uint64_t points,
                          const Progress& progress);

} // namespace isotet::linear
