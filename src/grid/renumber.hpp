// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A grid whose points are sorted by Grid::point_numbers, so that wherever point indices decide, the numbers do.
#pragma once

#include <cstdint>
#include <span>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>

#include "base/buffer.hpp"

namespace isotet::core {

struct Renumbered {
    Grid grid;                      ///< points and cells only
    Buffer<std::uint64_t> original; ///< new index -> index in the user's grid
};

/// Errors   invalid_data when the numbers are not 32- or 64-bit integers, one a point
Result<void> check_point_numbers(const Grid& grid);

/// `grid`   checked (check_cells), with point numbers
/// Errors   as check_point_numbers()
Result<Renumbered> sort_points_by_number(const Grid& grid);

/// The tuples with some numbers, in their order.
Array in_order(const Array& values, std::span<const std::uint64_t> original);

/// Source cells as other numbers, int64: `numbers` of the cells, uint64. -1 stays; empty ones: all stay.
ISOTET_API Array source_cells_by(const Array& cells, const Array& numbers);

} // namespace isotet::core
