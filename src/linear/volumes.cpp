// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/linear_cells.hpp>

#include "base/carry_out.hpp"
#include "base/parallel.hpp"
#include "grid/cell_faces.hpp"
#include "grid/values/average_to_points.hpp"
#include "linear/polyhedra/polyhedron.hpp"

namespace isotet {

namespace {

constexpr std::size_t cells_at_once = 1 << 11;

Error cancelled_volumes() { return {ErrorCode::cancelled, "finding volumes was cancelled"}; }

/// Of linear cells and polyhedra as they are.
Result<std::vector<double>> volumes_of_cells(const Grid& grid, const core::CellReader& cells,
                                             const Progress& progress) {
    if (auto sound = core::check_cells(grid, cells, progress); !sound) return sound.error();
    if (auto sound = core::check_faces(grid, cells, progress); !sound) return sound.error();
    const auto faces = core::FaceReader::open(grid.cells);
    if (!faces) return faces.error();
    const core::PointReader points(grid.points);
    const LinearizeOptions options;
    std::vector<double> volumes(cells.count());
    core::parallel_pieces(cells.count(), cells_at_once, progress, [&](std::size_t begin, std::size_t end) {
        linear::PolyhedronSplitter splitter(grid, cells, *faces, options);
        for (std::size_t cell = begin; cell < end; ++cell) {
            volumes[cell] = core::is_polyhedron(cells, *faces, cell) ? splitter.six_volumes(cell)
                                                                     : core::six_volumes_of(cells, points, cell);
        }
    });
    if (progress.cancelled()) return cancelled_volumes();
    return volumes;
}

/// Of the linear cells that the user's cells became, added up. A piece has whole cells of the user.
Result<std::vector<double>> volumes_by_source(const LinearGrid& linear, const Progress& progress) {
    const auto cells = core::CellReader::open(linear.grid);
    if (!cells) return cells.error();
    const core::PointReader points(linear.grid.points);
    const auto sources = linear.source_cells.as<std::uint64_t>();
    const auto source = [&](std::size_t cell) { return sources.empty() ? cell : sources[cell]; };
    std::vector<double> volumes(linear.user_cells, -1);
    core::parallel_pieces(cells->count(), cells_at_once, progress, [&](std::size_t begin, std::size_t end) {
        while (begin > 0 && begin < end && source(begin) == source(begin - 1)) ++begin;
        for (std::size_t cell = begin; cell < cells->count(); ++cell) {
            if (cell >= end && (begin >= end || source(cell) != source(cell - 1))) return;
            const double volume = core::six_volumes_of(*cells, points, cell);
            if (volume < 0) continue;
            double& sum = volumes[source(cell)];
            sum = sum < 0 ? volume : sum + volume;
        }
    });
    if (progress.cancelled()) return cancelled_volumes();
    return volumes;
}

} // namespace

Result<std::vector<double>> relative_volumes(const Grid& grid, const Run& run) {
    return core::carry_out("finding volumes", run, [&](const Progress& progress) -> Result<std::vector<double>> {
        const auto cells = core::CellReader::open(grid);
        if (!cells) return cells.error();
        if (grid.point_numbers.empty() && !has_curved_cells(grid.cells))
            return volumes_of_cells(grid, *cells, progress);
        const auto linear = linearize(grid, {}, {.progress = progress});
        if (!linear) return linear.error();
        return volumes_by_source(*linear, progress);
    });
}

} // namespace isotet
