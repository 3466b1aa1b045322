// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/linear_cells.hpp>

#include "base/carry_out.hpp"
#include "grid/cells.hpp"
#include "grid/points/hanging.hpp"

namespace isotet {

namespace {

Result<std::uint64_t> count_in_linear(const Grid& grid, const Progress& progress) {
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto sound = core::check_cells(grid, *cells, progress); !sound) return sound.error();
    const auto hanging = core::find_hanging(grid, *cells, progress);
    if (!hanging) return hanging.error();
    return hanging->points;
}

} // namespace

Result<std::uint64_t> count_hanging_points(const Grid& grid, const Run& run) {
    return core::carry_out("looking for hanging points", run, [&](const Progress& progress) -> Result<std::uint64_t> {
        if (!has_cells_to_linearize(grid.cells)) return count_in_linear(grid, progress);
        const auto linear = linearize({grid.points, grid.cells, {}, {}}, {}, {.progress = progress});
        if (!linear) return linear.error();
        return count_in_linear(linear->grid, progress);
    });
}

} // namespace isotet
