// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// survey() of grids whose cells become linear first.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>

#include "base/carry_out.hpp"
#include "base/parallel.hpp"
#include "grid/cell_survey.hpp"
#include "linear/checked_cells.hpp"
#include "linear/derived.hpp"
#include "linear/parts.hpp"
#include "linear/polyhedra/polyhedron.hpp"

namespace isotet {

namespace linear {

namespace {

constexpr std::size_t cells_of_part = 512; ///< what they become stays in a core's cache

/// Points and cells are counted as the user has them.
void count_as_given(GridReport& report, const Grid& grid) {
    report.points = grid.points.tuples();
    report.cells = grid.cells.count();
    report.cells_by_type.clear();
    for (const auto& [type, count] : count_cells_by_type(grid.cells)) report.cells_by_type[type] = count;
}

/// Where LinearGrid::extend() puts the derived points of a block.
void place_derived(const Parts& parts, const core::PointReader& points, bool single, std::vector<core::Point>& places) {
    places.clear();
    parts.for_rows([&](std::span<const std::uint64_t> of, std::span<const double> weights) {
        core::Point& place = places.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto at = [&](std::size_t i) { return points[of[i]][axis]; };
            const double value = within(derived_value(weights, of.size(), at), of.size(), at);
            place[axis] = single ? double{static_cast<float>(value)} : value;
        }
    });
}

/// Splits polyhedra and counts what they become, block by block. Nothing where that is not known without all linear cells:
/// there is no tet, or points are broken, which is told of linear cells.
Result<std::optional<GridReport>> survey_blocks(const Grid& grid, const Progress& progress) {
    std::optional<GridReport> nothing;
    if (has_curved_cells(grid.cells) || !core::all_points_are_sound(grid)) return nothing;
    const auto checked = checked_cells(grid, progress);
    if (!checked) return checked.error();
    const core::CellReader& cells = checked->cells;
    const core::PointReader points(grid.points);
    const bool single = grid.points.type() == ScalarType::float32;
    const LinearizeOptions options;
    core::TetSurveyor surveyor(grid.points);
    core::parallel_pieces(cells.count(), cells_of_part * 16, progress, [&](std::size_t begin, std::size_t end) {
        PolyhedronSplitter splitter(grid, cells, checked->faces, options);
        Parts parts;
        std::vector<core::Point> places;
        for (std::size_t first = begin; first < end && !progress.cancelled(); first += cells_of_part) {
            parts.clear();
            for (std::size_t cell = first; cell < std::min(end, first + cells_of_part); ++cell)
                if (core::is_polyhedron(cells, checked->faces, cell)) splitter.split(cell, parts);
                else parts.keep_cell(cells, cell);
            place_derived(parts, points, single, places);
            surveyor.add({parts.types(), parts.corner_counts(), parts.corners(), places});
        }
    });
    const core::TetSurvey tets = std::move(surveyor).finish(progress);
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "checking the grid was cancelled"};
    if (tets.tets == 0) return nothing;
    GridReport report = core::report_of(tets, grid.points, cells.count());
    count_as_given(report, grid);
    progress("check", 1);
    return std::optional(std::move(report));
}

/// Tets, faces and bounds are those of the linear cells.
Result<GridReport> survey_as_linear(const Grid& grid, const SurveyOptions& options, const Progress& progress) {
    if (!options.faces) {
        auto counted = survey_blocks(grid, progress);
        if (!counted) return counted.error();
        if (*counted) return **std::move(counted);
    }
    const auto linear = isotet::linearize({grid.points, grid.cells, {}, {}}, {}, {.progress = progress});
    if (!linear) return linear.error();
    auto report = core::survey_linear_cells(linear->grid, options, progress);
    if (!report) return report;
    report->cells_left_out += linear->refinement.left_out;
    count_as_given(*report, grid);
    return report;
}

} // namespace

} // namespace linear

Result<GridReport> survey(const Grid& grid, const SurveyOptions& options, const Run& run) {
    return core::carry_out("checking the grid", run, [&](const Progress& progress) {
        return has_cells_to_linearize(grid.cells) ? linear::survey_as_linear(grid, options, progress)
                                                  : core::survey_linear_cells(grid, options, progress);
    });
}

} // namespace isotet
