// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// survey() and split(): what a grid holds, without packing it.
#include <algorithm>
#include <atomic>

#include <tbb/parallel_sort.h>

#include "core/faces.hpp"
#include "core/guard.hpp"
#include "core/memory.hpp"
#include "core/orientation.hpp"
#include "core/parallel.hpp"
#include "core/tet_survey.hpp"

namespace isotet {

namespace core {

namespace {

/// Points that contoured cells use, as flags.
Buffer<std::uint8_t> used_points(const Grid& grid, const CellReader& cells) {
    Buffer<std::uint8_t> used(grid.points.tuples());
    parallel_ranges(used.size(), 1 << 18, [&](std::size_t begin, std::size_t end) {
        std::fill(used.begin() + begin, used.begin() + end, 0);
    });
    parallel_each(cells.count(), 1 << 14, [&](std::size_t cell) {
        if (!is_contoured(cells.type(cell))) return;
        const std::uint64_t first = cells.first(cell);
        for (std::uint64_t k = 0; k < cells.corners(cell); ++k)
            std::atomic_ref<std::uint8_t>(used[cells.corner(first + k)]).store(1, std::memory_order_relaxed);
    });
    return used;
}

/// Used points with the coordinates of a used point of a lower number.
std::size_t count_duplicates(const Grid& grid, const Buffer<std::uint8_t>& used) {
    const PointReader points(grid.points);
    std::vector<std::uint64_t> numbers;
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i]) numbers.push_back(i);
    tbb::parallel_sort(numbers.begin(), numbers.end(),
                       [&](std::uint64_t a, std::uint64_t b) { return points[a] < points[b]; });
    std::atomic<std::size_t> duplicates{0};
    parallel_ranges(numbers.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        std::size_t count = 0;
        for (std::size_t i = std::max<std::size_t>(begin, 1); i < end; ++i)
            count += points[numbers[i - 1]] == points[numbers[i]];
        duplicates += count;
    });
    return duplicates;
}

Result<GridReport> survey(const Grid& grid, const SurveyOptions& options, const Progress& progress) {
    auto cells = CellReader::open(grid);
    if (!cells) return cells.error();
    GridReport report;
    report.points = grid.points.tuples();
    report.cells = cells->count();
    if (grid.cells.types.empty() && report.cells) report.cells_by_type[cells->type(0)] = report.cells;
    else
        for (std::size_t cell = 0; cell < cells->count(); ++cell) ++report.cells_by_type[cells->type(cell)];
    if (auto ok = check_cells(grid, *cells, progress); !ok) return ok.error();
    progress("check", 0.2);

    const TetSurvey tets = survey_tets(grid, *cells);
    if (tets.tets == 0) return nothing_to_contour(grid, *cells);
    report.tets = tets.tets;
    report.collapsed_tets = tets.collapsed;
    report.cells_left_out = tets.left_out;
    report.lower = tets.lower;
    report.upper = tets.upper;
    progress("check", 0.4);
    const Buffer<std::uint8_t> used = used_points(grid, *cells);
    report.unused_points = static_cast<std::size_t>(std::count(used.begin(), used.end(), 0));
    if (!options.faces) return report;

    report.duplicate_points = count_duplicates(grid, used);
    // A quarter of what is free, but no less than a small grid needs.
    const auto faces = survey_faces(grid, *cells, tets, std::max<std::uint64_t>(free_memory() / 4, 1 << 26), progress);
    if (!faces) return faces.error();
    report.repeated_tets = faces->repeated;
    report.negative_tets = faces->orientation.negative + faces->orientation.twisted;
    report.inverted_tets = faces->inverted;
    report.flat_tets = faces->orientation.flat;
    report.boundary_faces = faces->boundary_faces;
    progress("check", 1);
    return report;
}

Result<TetList> split(const Grid& grid, const Progress& progress) {
    auto cells = CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto ok = check_cells(grid, *cells, progress); !ok) return ok.error();
    TetList list;
    for (std::size_t cell = 0; cell < cells->count(); ++cell)
        for (const Tet& tet : cells->tets(cell)) {
            list.tets.push_back(tet);
            list.cells.push_back(cell);
        }
    if (list.tets.empty()) return nothing_to_contour(grid, *cells);
    return list;
}

} // namespace
} // namespace core

Result<GridReport> survey(const Grid& grid, const SurveyOptions& options, const Progress& progress) {
    return core::guarded("checking the grid", [&]() -> Result<GridReport> {
        Result<GridReport> result = Error{};
        core::with_threads(options.threads, [&] { result = core::survey(grid, options, progress); });
        return result;
    });
}

Result<TetList> split(const Grid& grid, const Progress& progress) {
    return core::guarded("splitting the cells", [&] { return core::split(grid, progress); });
}

} // namespace isotet
