// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Some cells of a grid as a grid.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <isotet/grid.hpp>

#include "grid/fixed_corners.hpp"

namespace isotet::core {

/// Cells of one type, by their corners. `points`   a grid with the points alone
inline Grid block_of(const Grid& points, CellType type, const Array& corners) {
    Grid block = points;
    block.cells.uniform_type = type;
    block.cells.connectivity = corners;
    return block;
}

/// Cells with a type each, of types with a fixed number of corners; types and corners are borrowed.
inline Grid block_of(const Grid& points, std::span<const std::uint8_t> types, const Array& corners) {
    Grid block = points;
    block.cells.types = Array(ScalarType::uint8, types.data(), types.size(), 1, nullptr);
    std::vector<std::uint64_t> offsets{0};
    offsets.reserve(types.size() + 1);
    for (const std::uint8_t type : types) offsets.push_back(offsets.back() + fixed_corners_of(type));
    block.cells.offsets = Array::own(std::move(offsets));
    block.cells.connectivity = corners;
    return block;
}

} // namespace isotet::core
