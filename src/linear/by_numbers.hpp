// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Making cells linear where Grid::point_numbers decide: on the grid with sorted points, and back.
#pragma once

#include <isotet/linear_cells.hpp>

#include "grid/renumber.hpp"

namespace isotet::linear {

/// As core::sort_points_by_number(), faces too.
/// Errors   invalid_data where cells, faces or numbers are broken; cancelled
Result<core::Renumbered> sort_by_numbers(const Grid& grid, const Progress& progress);

/// What the sorted grid became, in the user's order of points. Derived points have numbers above the user's.
/// Errors   invalid_data when there are no such numbers
Result<LinearGrid> in_users_order(LinearGrid&& sorted, const Grid& user, const core::Buffer<std::uint64_t>& original);

} // namespace isotet::linear
