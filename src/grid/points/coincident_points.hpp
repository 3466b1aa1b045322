// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Points that are doubled, at one place or apart by roundings: estimate_coincident_points(), and how far they are apart.
#pragma once

#include <cstdint>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>

namespace isotet::core {

/// What roundings of a coordinate are of the largest one, at most.
constexpr double share_of_rounding(ScalarType type) { return type == ScalarType::float32 ? 0x1p-23 : 0x1p-33; }

/// As CoincidentPoints.
struct DoubledPoints {
    std::uint64_t points = 0;
    bool estimated = false;
    double gap = 0; ///< the largest distance of one from the first at its place
};

/// As estimate_coincident_points().
ISOTET_API DoubledPoints estimate_doubled_points(const Grid& grid, const Run& run = {});

/// Whether estimate_doubled_points() may find some, whatever the cells are. `are_cells_apart`   they share next to no points
ISOTET_API bool may_have_doubled_points(const Array& points, bool are_cells_apart, const Run& run = {});

} // namespace isotet::core
