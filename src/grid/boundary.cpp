// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/boundary.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>

#include "base/carry_out.hpp"
#include "base/memory.hpp"
#include "grid/boundary_faces.hpp"
#include "grid/faces.hpp"
#include "grid/sheet.hpp"

namespace isotet {

namespace core {

namespace {

Surface surface_of(const Array& all_points, const std::vector<BoundaryFace>& faces) {
    const std::vector<std::uint64_t> points = points_of_faces(faces);
    Surface surface;
    place_vertices(surface, all_points, points);
    surface.triangles = triangles_of_faces(faces, points);
    return surface;
}

Result<Surface> boundary_of_grid(const Grid& grid, const Progress& progress) {
    const auto cells = CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto ok = check_cells(grid, *cells, progress); !ok) return ok.error();
    const TetSurvey tets = survey_tets(grid, *cells, progress);
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "finding the boundary was cancelled"};
    if (tets.tets == 0) return nothing_to_contour(grid, *cells);
    constexpr std::uint64_t enough_for_small_grids = 1 << 26;
    const std::uint64_t memory = std::max(free_memory() / 4, enough_for_small_grids);
    const auto faces = find_boundary_faces(grid, *cells, tets, {.memory = memory}, progress);
    if (!faces) return faces.error();
    constexpr std::uint64_t max_numbers = std::numeric_limits<std::uint32_t>::max();
    if (3 * faces->size() > max_numbers && grid.points.tuples() > max_numbers)
        return Error{ErrorCode::invalid_data, fmt::format("the boundary has {} faces, but of a grid of more than 2^32 "
                                                          "points it must have at most {}",
                                                          faces->size(), max_numbers / 3)};
    return surface_of(grid.points, *faces);
}

} // namespace
} // namespace core

Result<Surface> boundary_of(const Grid& grid, const Run& run) {
    return core::carry_out("finding the boundary", run, [&](const Progress& progress) -> Result<Surface> {
        if (has_only_flat_cells(grid.cells)) return core::sheet_of(grid, progress);
        if (!has_cells_to_linearize(grid.cells)) return core::boundary_of_grid(grid, progress);
        const auto linear =
            linearize({grid.points, grid.cells, {}, {}}, {}, {.threads = core::threads_here(), .progress = {}});
        if (!linear) return linear.error();
        return core::boundary_of_grid(linear->grid, progress);
    });
}

Result<DrawnGrid> grid_with_joined_points(const Grid& grid, const Run& run) {
    DrawnGrid drawn{{grid.points, grid.cells, {}, {}, grid.point_numbers}, false};
    if (!may_have_coincident_points(grid.points)) return drawn;
    if (2 * estimate_coincident_points(grid).points < grid.points.tuples()) return drawn;
    Result<MergedPoints> merged = merge_points(drawn.grid, {rounding_of(grid.points), MergedValues::lowest}, run);
    if (!merged && merged.error().code == ErrorCode::invalid_argument) return drawn; // all cells would collapse
    if (!merged) return merged.error();
    if (merged->collapsed_cells > 0) return drawn;
    drawn.grid = std::move(merged->grid);
    drawn.joined = true;
    return drawn;
}

} // namespace isotet
