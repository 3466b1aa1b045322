// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// survey() and split(): what a grid holds, without packing it.
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <isotet/grid.hpp>

#include "base/carry_out.hpp"
#include "base/system/memory.hpp"
#include "grid/cell_block.hpp"
#include "grid/cell_survey.hpp"
#include "grid/faces.hpp"
#include "grid/mixed_faces.hpp"
#include "grid/points/duplicate_points.hpp"
#include "grid/renumber.hpp"
#include "grid/tet_survey.hpp"
#include "numbers/bounds.hpp"

namespace isotet {

namespace core {

namespace {

Error cancelled() { return {ErrorCode::cancelled, "checking the grid was cancelled"}; }

/// Of a grid without tets: the box around all points that are finite.
void take_bounds_of_all(GridReport& report, const Array& points) {
    Bounds bounds;
    const PointReader reader(points);
    for (std::size_t i = 0; i < points.tuples(); ++i)
        if (const Point point = reader[i]; std::ranges::all_of(point, [](double x) { return std::isfinite(x); }))
            bounds.add(point);
    if (bounds.lower[0] > bounds.upper[0]) return;
    report.lower = bounds.lower;
    report.upper = bounds.upper;
}

Result<TetList> split_by_index(const Grid& grid, const Progress& progress) {
    auto cells = CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto ok = check_cells(grid, *cells, progress); !ok) return ok.error();
    TetList list;
    for (std::size_t cell = 0; cell < cells->count(); ++cell) {
        if (cell % (1 << 16) == 0 && progress.cancelled()) return cancelled();
        for (const Tet& tet : cells->tets(cell)) {
            list.tets.push_back(tet);
            list.cells.push_back(cell);
        }
    }
    if (list.tets.empty()) return nothing_to_contour(grid, *cells);
    return list;
}

Result<TetList> split(const Grid& grid, const Progress& progress) {
    if (grid.point_numbers.empty()) return split_by_index(grid, progress);
    const auto cells = CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto ok = check_cells(grid, *cells, progress); !ok) return ok.error();
    const auto sorted = sort_points_by_number(grid);
    if (!sorted) return sorted.error();
    auto list = split_by_index(sorted->grid, progress);
    if (!list) return list;
    for (auto& tet : list->tets)
        for (std::uint64_t& corner : tet) corner = sorted->original[corner];
    return list;
}

} // namespace

GridReport report_of(const TetSurvey& tets, const Array& points, std::uint64_t cells) {
    GridReport report;
    report.points = points.tuples();
    report.cells = cells;
    for (std::size_t type = 0; type < tets.cells_by_type.size(); ++type)
        if (tets.cells_by_type[type]) report.cells_by_type[static_cast<std::uint8_t>(type)] = tets.cells_by_type[type];
    report.cells_left_out = tets.left_out;
    report.tets = tets.tets;
    report.collapsed_tets = tets.collapsed;
    report.negative_tets = tets.orientation.negative + tets.orientation.twisted;
    report.inverted_tets = tets.orientation.inverted(tets.mostly_negative());
    report.flat_tets = tets.orientation.flat;
    report.unused_points = tets.unused;
    report.lower = tets.lower;
    report.upper = tets.upper;
    if (tets.tets == 0) take_bounds_of_all(report, points);
    return report;
}

Result<GridReport> survey_linear_cells(const Grid& grid, const SurveyOptions& options, const Progress& progress) {
    auto cells = CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto ok = check_cells(grid, *cells, progress); !ok) return ok.error();
    progress("check", 0.1);
    const TetSurvey tets = survey_tets(grid, *cells, progress);
    if (progress.cancelled()) return cancelled();
    GridReport report = report_of(tets, grid.points, cells->count());
    if (tets.tets == 0) return report;
    if (options.faces) {
        progress("check", 0.4);
        report.duplicate_points = count_duplicates(PointReader(grid.points), tets.used, progress);
        if (progress.cancelled()) return cancelled();
        progress("check", 0.6);
        // A quarter of what is free, but no less than a small grid needs.
        const std::uint64_t memory = std::max<std::uint64_t>(free_memory() / 4, 1 << 26);
        const auto faces = survey_faces(grid, *cells, tets, {.memory = memory}, progress);
        if (!faces) return faces.error();
        report.repeated_tets = faces->repeated;
        report.boundary_faces = faces->boundary_faces;
        report.quads_on_triangles = count_quads_on_triangles(*cells, memory, progress);
        if (progress.cancelled()) return cancelled();
    }
    progress("check", 1);
    return report;
}

CellSurvey::CellSurvey(const Array& points) : tets_(points) {
    block_.points = points;
    points_are_sound_ = all_points_are_sound(block_);
}

void CellSurvey::add(CellType type, const Array& corners) { add(block_of(block_, type, corners)); }

void CellSurvey::add(std::span<const std::uint8_t> types, const Array& corners) {
    add(block_of(block_, types, corners));
}

void CellSurvey::add(const Grid& block) {
    const auto cells = CellReader::open(block);
    if (!cells || !all_are_sound(block, *cells, 0, cells->count(), points_are_sound_)) {
        broken_ = true;
        return;
    }
    tets_.add(*cells, 0, cells->count());
    cells_ += cells->count();
}

std::optional<GridReport> CellSurvey::finish(const Progress& progress) {
    if (broken_) return std::nullopt;
    return report_of(std::move(tets_).finish(progress), block_.points, cells_);
}

} // namespace core

Result<TetList> split(const Grid& grid, const Run& run) {
    return core::carry_out("splitting the cells", run,
                           [&](const Progress& progress) { return core::split(grid, progress); });
}

} // namespace isotet
