// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A grid without the points that none of its cells uses.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>

namespace isotet::core {

/// Keeps the points that a cell uses, in their order, and what belongs to them. Cells of VTK's type 0 use none: their corners
/// become point 0. A corner that is no point stays none, so that the checks of the grid say so.
///
/// Returns   a byte a point of before, 1 where it was kept; empty: all were
ISOTET_API std::vector<std::uint8_t> keep_used_points(Grid& grid);

/// The tuples of `values` whose number `kept` marks; an empty array stays empty.
ISOTET_API Array kept_tuples(const Array& values, const std::vector<std::uint8_t>& kept);

} // namespace isotet::core
