// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/pieces.hpp>

#include <algorithm>
#include <bit>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/radix_sort.hpp"
#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "grid/renumber.hpp"
#include "grid/surface_rows.hpp"

namespace isotet {

namespace {

constexpr std::size_t pieces_grain = 1 << 16;

/// Asks for every so many cells.
bool is_cancelled_at(std::uint64_t cell, const Progress& progress) {
    return cell % pieces_grain == 0 && progress.cancelled();
}

Error taking_cancelled() { return {ErrorCode::cancelled, "taking cells was cancelled"}; }

core::Buffer<std::uint64_t> run_of(std::uint64_t first, std::uint64_t last) {
    core::Buffer<std::uint64_t> out(last - first);
    for (std::uint64_t i = first; i < last; ++i) out[i - first] = i;
    return out;
}

std::vector<Field> in_order(const std::vector<Field>& fields, const core::Buffer<std::uint64_t>& kept) {
    std::vector<Field> out;
    for (const Field& field : fields) out.push_back({field.name, core::in_order(field.values, kept)});
    return out;
}

/// The points that some cells use, ascending.
Result<core::Buffer<std::uint64_t>> used_points(const core::CellReader& cells, std::uint64_t first, std::uint64_t last,
                                                const Progress& progress) {
    std::vector<std::uint8_t> used(cells.points(), 0);
    std::uint64_t count = 0;
    for (std::uint64_t cell = first; cell < last; ++cell) {
        if (is_cancelled_at(cell - first, progress)) return taking_cancelled();
        const std::uint64_t begin = cells.first(cell), corners = cells.corners(cell);
        if (corners > cells.connectivity_size() || begin > cells.connectivity_size() - corners)
            return invalid_data(fmt::format("cells[{}] ends beyond the connectivity, which has {} entries", cell,
                                            cells.connectivity_size()));
        for (std::uint64_t i = begin; i < begin + corners; ++i) {
            const std::uint64_t point = cells.corner(i);
            if (point >= used.size())
                return invalid_data(fmt::format("cells[{}] has point {}, but the grid has {} points", cell,
                                                static_cast<std::int64_t>(point), used.size()));
            count += !used[point];
            used[point] = 1;
        }
    }
    core::Buffer<std::uint64_t> out(count);
    std::uint64_t next = 0;
    for (std::uint64_t point = 0; point < used.size(); ++point)
        if (used[point]) out[next++] = point;
    return out;
}

/// The faces of some cells, where `renumber` has their points.
template <class Renumber>
Result<void> take_faces(const Grid& grid, std::uint64_t first, std::uint64_t last, Renumber&& renumber, Cells& out,
                        const Progress& progress) {
    const auto faces = core::FaceReader::open(grid.cells);
    if (!faces) return faces.error();
    if (!faces->has_faces()) return {};
    std::vector<std::int64_t> stream, offsets{0};
    for (std::uint64_t cell = first; cell < last; ++cell) {
        if (is_cancelled_at(cell - first, progress)) return taking_cancelled();
        if (const std::string fault = core::fault_of_faces(*faces, cell, grid.points.tuples()); !fault.empty())
            return invalid_data(fmt::format("cells[{}] {}", cell, fault));
        std::uint64_t at = faces->begin(cell);
        const std::uint64_t end = faces->end(cell);
        if (at < end) stream.push_back(static_cast<std::int64_t>(faces->at(at++)));
        while (at < end) {
            const std::uint64_t count = faces->at(at++);
            stream.push_back(static_cast<std::int64_t>(count));
            for (std::uint64_t i = 0; i < count; ++i) {
                const std::uint64_t point = faces->at(at++);
                stream.push_back(renumber(point));
                if (stream.back() < 0)
                    return invalid_data(
                        fmt::format("cells[{}] has a face with point {}, which its connectivity has not", cell, point));
            }
        }
        offsets.push_back(static_cast<std::int64_t>(stream.size()));
    }
    out.faces = Array::own(std::move(stream));
    out.face_offsets = Array::own(std::move(offsets));
    return {};
}

Result<Cells> cells_of(const Grid& grid, const core::CellReader& cells, std::uint64_t first, std::uint64_t last,
                       const core::Buffer<std::uint64_t>& points, const Progress& progress) {
    std::vector<std::int64_t> place(cells.points(), -1);
    for (std::size_t i = 0; i < points.size(); ++i) place[points[i]] = static_cast<std::int64_t>(i);
    std::uint64_t corners = 0;
    for (std::uint64_t cell = first; cell < last; ++cell) corners += cells.corners(cell);
    core::Buffer<std::int64_t> connectivity(corners), offsets(last - first + 1);
    std::uint64_t next = 0;
    for (std::uint64_t cell = first; cell < last; ++cell) {
        if (is_cancelled_at(cell - first, progress)) return taking_cancelled();
        offsets[cell - first] = static_cast<std::int64_t>(next);
        const std::uint64_t begin = cells.first(cell);
        for (std::uint64_t i = 0; i < cells.corners(cell); ++i) connectivity[next++] = place[cells.corner(begin + i)];
    }
    offsets[last - first] = static_cast<std::int64_t>(next);
    Cells out;
    out.uniform_type = grid.cells.uniform_type;
    out.connectivity = std::move(connectivity).to_array();
    if (!grid.cells.offsets.empty()) out.offsets = std::move(offsets).to_array();
    if (!grid.cells.types.empty()) out.types = core::in_order(grid.cells.types, run_of(first, last));
    const auto renumber = [&](std::uint64_t point) { return place[point]; };
    if (auto taken = take_faces(grid, first, last, renumber, out, progress); !taken) return taken.error();
    return out;
}

Array numbers_of(const Grid& grid, const core::Buffer<std::uint64_t>& points) {
    if (!grid.point_numbers.empty()) return core::in_order(grid.point_numbers, points);
    core::Buffer<std::int64_t> numbers(points.size());
    std::copy(points.begin(), points.end(), numbers.begin());
    return std::move(numbers).to_array();
}

Result<Grid> take(const Grid& grid, std::uint64_t first, std::uint64_t last, const Progress& progress) {
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    if (first > last || last > cells->count())
        return invalid_argument(
            fmt::format("the cells [{}, {}) are asked for, but the grid has {} cells", first, last, cells->count()));
    if (!grid.point_numbers.empty() && grid.point_numbers.tuples() != grid.points.tuples())
        return invalid_data(fmt::format("there are {} point numbers, but {} points", grid.point_numbers.tuples(),
                                        grid.points.tuples()));
    const auto points = used_points(*cells, first, last, progress);
    if (!points) return points.error();
    Grid out;
    auto taken = cells_of(grid, *cells, first, last, *points, progress);
    if (!taken) return taken.error();
    out.points = core::in_order(grid.points, *points);
    out.cells = *std::move(taken);
    out.point_fields = in_order(grid.point_fields, *points);
    out.cell_fields = in_order(grid.cell_fields, run_of(first, last));
    out.point_numbers = numbers_of(grid, *points);
    return out;
}

/// Ascending as the numbers are, -0 equal to +0.
std::uint64_t sortable(double x) {
    const auto bits = std::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x);
    return bits >> 63 ? ~bits : bits | std::uint64_t{1} << 63;
}

Array ranks_by_coordinates(const Array& points) {
    core::Buffer<core::Keyed> sorted(points.tuples()), scratch(points.tuples());
    for (std::size_t i = 0; i < sorted.size(); ++i) sorted[i].number = i;
    points.visit([&](auto coordinates) {
        for (std::size_t axis = 3; axis-- > 0;) { // the sort is stable
            core::parallel_each(sorted.size(), pieces_grain, [&](std::size_t i) {
                sorted[i].key = sortable(static_cast<double>(coordinates[3 * sorted[i].number + axis]));
            });
            core::radix_sort({sorted.data(), sorted.size()}, {scratch.data(), scratch.size()});
        }
    });
    core::Buffer<std::int64_t> ranks(sorted.size());
    core::parallel_each(sorted.size(), pieces_grain,
                        [&](std::size_t i) { ranks[sorted[i].number] = static_cast<std::int64_t>(i); });
    return std::move(ranks).to_array();
}

/// Whether a cell is marked.
Result<std::vector<std::uint8_t>> marked(const Array& marks, std::uint64_t bits) {
    if (is_floating(marks.type()) || marks.components() != 1)
        return invalid_argument(fmt::format("the marks of cells are {} with {} components, but must be integers with 1",
                                            name_of(marks.type()), marks.components()));
    std::vector<std::uint8_t> out(marks.tuples());
    marks.visit([&]<class T>(std::span<const T> typed) {
        if constexpr (std::is_integral_v<T>)
            for (std::size_t cell = 0; cell < out.size(); ++cell)
                out[cell] = (static_cast<std::uint64_t>(typed[cell]) & bits) != 0;
    });
    return out;
}

Result<Grid> leave_out(const Grid& grid, const Array& marks, std::uint64_t bits) {
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    const auto out_of = marked(marks, bits);
    if (!out_of) return out_of.error();
    if (out_of->size() != cells->count())
        return invalid_argument(
            fmt::format("there are {} marks, but the grid has {} cells", out_of->size(), cells->count()));
    core::Buffer<std::uint8_t> types(cells->count());
    for (std::size_t cell = 0; cell < types.size(); ++cell)
        types[cell] = (*out_of)[cell] ? std::uint8_t{0} : cells->type(cell);
    Grid out = grid;
    if (grid.cells.offsets.empty()) {
        core::Buffer<std::int64_t> offsets(cells->count() + 1);
        for (std::size_t cell = 0; cell <= cells->count(); ++cell)
            offsets[cell] = static_cast<std::int64_t>(cells->first(cell));
        out.cells.offsets = std::move(offsets).to_array();
    }
    out.cells.types = std::move(types).to_array();
    return out;
}

Result<Surface> leave_out(const Surface& surface, const Array& marks, std::uint64_t bits) {
    const auto out_of = marked(marks, bits);
    if (!out_of) return out_of.error();
    if (surface.source_cells.tuples() != surface.triangle_count() || surface.source_cells.type() != ScalarType::int64)
        return invalid_argument(fmt::format("the surface has {} source cells for {} triangles, but each needs one",
                                            surface.source_cells.tuples(), surface.triangle_count()));
    const auto source = surface.source_cells.as<std::int64_t>();
    for (const std::int64_t cell : source)
        if (static_cast<std::uint64_t>(cell) >= out_of->size())
            return invalid_argument(
                fmt::format("the surface has triangles of cell {}, but there are {} marks", cell, out_of->size()));
    std::vector<std::uint64_t> kept;
    for (std::size_t i = 0; i < source.size(); ++i)
        if (!(*out_of)[static_cast<std::size_t>(source[i])]) kept.push_back(i);
    return core::with_triangles(surface, kept);
}

} // namespace

Result<Grid> take_cells(const Grid& grid, std::uint64_t first, std::uint64_t last, const Run& run) {
    return core::carry_out("taking cells", run,
                           [&](const Progress& progress) { return take(grid, first, last, progress); });
}

std::uint64_t first_cell_of(const Grid& grid, const PieceOf& which) noexcept {
    if (which.pieces == 0) return 0;
    const std::uint64_t cells = grid.cells.count();
    return cells / which.pieces * which.piece + std::min(which.piece, cells % which.pieces);
}

Result<Grid> take_piece(const Grid& grid, const PieceOf& which, const Run& run) {
    if (which.piece >= which.pieces)
        return invalid_argument(
            fmt::format("piece {} is asked for, but there are {} pieces, numbered from 0", which.piece, which.pieces));
    return take_cells(grid, first_cell_of(grid, which), first_cell_of(grid, {which.piece + 1, which.pieces}), run);
}

Result<Array> number_points_by_coordinates(const Array& points, const Run& run) {
    return core::carry_out("numbering points", run, [&](const Progress&) -> Result<Array> {
        if (!is_floating(points.type()) || points.components() != 3)
            return invalid_data(fmt::format("points are {} with {} components, but must be float32 or float64 with 3",
                                            name_of(points.type()), points.components()));
        return ranks_by_coordinates(points);
    });
}

Result<Grid> leave_out_cells(const Grid& grid, const Array& marks, std::uint64_t bits, const Run& run) {
    return core::carry_out("leaving out cells", run, [&](const Progress&) { return leave_out(grid, marks, bits); });
}

Result<Surface> leave_out_triangles(const Surface& surface, const Array& marks, std::uint64_t bits, const Run& run) {
    return core::carry_out("leaving out triangles", run,
                           [&](const Progress&) { return leave_out(surface, marks, bits); });
}

} // namespace isotet
