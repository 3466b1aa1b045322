// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/boundary.hpp>

#include <cstdint>
#include <utility>

#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>

#include "base/carry_out.hpp"
#include "base/system/memory.hpp"
#include "grid/boundary_search.hpp"
#include "grid/cells.hpp"
#include "grid/sheet.hpp"

namespace isotet {

namespace core {

namespace {

constexpr std::size_t cells_per_piece = 1 << 14;

Result<Surface> boundary_of_grid(const Grid& grid, const Progress& progress) {
    const auto cells = CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto enough = require_memory("finding the boundary", BoundarySearch::bytes(cells->points())); !enough)
        return enough.error();
    BoundarySearch search(grid.points);
    parallel_pieces(cells->count(), cells_per_piece, progress,
                    [&](std::size_t begin, std::size_t end) { search.add(grid, *cells, begin, end); });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "finding the boundary was cancelled"};
    if (!search.look()) {
        if (auto ok = check_cells(grid, *cells, progress); !ok) return ok.error();
        return nothing_to_contour(grid, *cells);
    }
    progress("check", 0.75);
    parallel_pieces(cells->count(), cells_per_piece, progress,
                    [&](std::size_t begin, std::size_t end) { search.keep(begin, *cells, begin, end); });
    if (!search.has_kept_all()) return std::move(search).finish(grid, *cells, progress);
    auto found = std::move(search).finish(progress);
    if (!found) return found.error();
    return std::move(found->surface);
}

} // namespace
} // namespace core

Result<Surface> boundary_of(const Grid& grid, const Run& run) {
    return core::carry_out("finding the boundary", run, [&](const Progress& progress) -> Result<Surface> {
        if (has_only_flat_cells(grid.cells)) return core::sheet_of(grid, progress);
        if (!has_cells_to_linearize(grid.cells)) return core::boundary_of_grid(grid, progress);
        const auto linear = linearize({grid.points, grid.cells, {}, {}}, {}, {.progress = progress});
        if (!linear) return linear.error();
        return core::boundary_of_grid(linear->grid, progress);
    });
}

Result<DrawnGrid> grid_with_joined_points(const Grid& grid, const Run& run) {
    DrawnGrid drawn{{grid.points, grid.cells, {}, {}, grid.point_numbers}, false};
    if (!may_have_coincident_points(grid.points, run)) return drawn;
    if (2 * estimate_coincident_points(grid, run).points < grid.points.tuples()) return drawn;
    Result<MergedPoints> merged = merge_points(drawn.grid, {rounding_of(grid.points, run), MergedValues::lowest}, run);
    if (!merged && merged.error().code == ErrorCode::invalid_argument) return drawn; // all cells would collapse
    if (!merged) return merged.error();
    if (merged->collapsed_cells > 0) return drawn;
    drawn.grid = std::move(merged->grid);
    drawn.joined = true;
    return drawn;
}

} // namespace isotet
