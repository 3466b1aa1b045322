// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Linear cells in the making: blocks of the user's cells are done side by side, then put together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <isotet/linear_cells.hpp>

namespace isotet::linear {

/// What a block of cells becomes. A corner with the highest bit set is derived point `corner - derived_bit` of the block.
struct Parts {
    static constexpr std::uint64_t derived_bit = std::uint64_t{1} << 63;

    std::vector<std::uint64_t> corners, ends, sources; ///< of cells
    std::vector<std::uint8_t> types;
    std::vector<std::uint64_t> row_ends, row_points; ///< of derived points
    std::vector<double> row_weights;
    LinearizeReport report;

    void add_cell(std::uint8_t type, std::span<const std::uint64_t> cell_corners, std::uint64_t source);
    /// Returns the corner that means it.
    std::uint64_t add_point(std::span<const std::uint64_t> points, std::span<const double> weights);
};

/// The blocks in their order; takes them apart. Sets cells, points' weights, sources and the report, not the points.
LinearGrid joined(std::vector<Parts>& blocks, std::uint64_t user_points);

} // namespace isotet::linear
