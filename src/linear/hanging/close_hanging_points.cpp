// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/linear_cells.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include <fmt/format.h>

#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "linear/checked_cells.hpp"
#include "linear/curved/curved_kinds.hpp"
#include "linear/derived.hpp"
#include "linear/hanging/corner_cells.hpp"
#include "linear/hanging/covers.hpp"
#include "linear/hanging/hanging_rows.hpp"
#include "linear/hanging/listed_cells.hpp"
#include "linear/hanging/open_faces.hpp"
#include "linear/hanging/own_nodes.hpp"

namespace isotet {

namespace linear {

namespace {

/// A checked grid, and its faces without a neighbour.
struct OpenGrid {
    core::CellReader cells;
    core::FaceReader faces;
    OpenFaces open;
};

Result<OpenGrid> open_faces_of(const Grid& grid, const Progress& progress) {
    const auto all = checked_cells(grid, progress);
    if (!all) return all.error();
    auto open = find_open_faces(all->cells, all->faces, progress);
    if (!open) return open.error();
    return OpenGrid{all->cells, all->faces, *std::move(open)};
}

/// Errors of cells that are curved are those who refine them to tell: nothing is open of a grid that has some.
Result<OpenGrid> open_faces_of_corners(const Grid& corners, const Progress& progress) {
    auto all = open_faces_of(corners, progress);
    if (all || all.error().code != ErrorCode::invalid_data) return all;
    const Grid nothing{corners.points, {}, {}, {}};
    return open_faces_of(nothing, progress);
}

/// Whether all that the cells have is in the connectivity, at points that are there.
bool can_be_copied(const core::CellReader& cells) {
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        const std::uint64_t first = cells.first(cell), count = cells.corners(cell), size = cells.connectivity_size();
        if (first > size || count > size - first) return false;
        for (std::uint64_t i = first; i < first + count; ++i)
            if (cells.corner(i) >= cells.points()) return false;
    }
    return true;
}

/// A curved cell that lists hanging points has values of its own at these: its neighbours' values are not looked at.
void leave_out_points_of(const std::vector<std::uint8_t>& left_out, ClosedGrid& closed) {
    if (closed.points.empty()) return;
    const auto points = closed.points.as<std::uint64_t>(), corners = closed.parents.points.as<std::uint64_t>();
    const auto first = closed.parents.first.as<std::uint64_t>();
    const auto weights = closed.parents.weights.as<double>();
    std::vector<std::uint64_t> kept, kept_first{0}, kept_corners;
    std::vector<double> kept_weights;
    for (std::size_t row = 0; row < points.size(); ++row) {
        if (left_out[points[row]] != 0) continue;
        kept.push_back(points[row]);
        for (std::uint64_t i = first[row]; i < first[row + 1]; ++i) {
            kept_corners.push_back(corners[i]);
            kept_weights.push_back(weights[i]);
        }
        kept_first.push_back(kept_corners.size());
    }
    closed.points = Array::own(std::move(kept));
    closed.parents = {Array::own(std::move(kept_first)), Array::own(std::move(kept_corners)),
                      Array::own(std::move(kept_weights))};
}

/// Cells above degree 1 that list points become polyhedra of the grid's own nodes: their other curved neighbours and the
/// smaller cells give nodes to their edges and faces when these are refined.
Result<ClosedGrid> close_curved_cells(const Grid& grid, const Progress& progress) {
    ClosedGrid out{grid, {}, {}, {}};
    const CornerCells corners = corner_cells(grid);
    const auto all = open_faces_of_corners(corners.grid, progress);
    if (!all) return all.error();
    progress("check", 0.6);
    const core::PointReader points(grid.points);
    auto covers = find_covers(all->open, all->cells, points, progress);
    if (!covers) return covers.error();
    if (covers->whole.empty() && covers->open.empty()) return out;
    const auto cells = core::CellReader::open(grid);
    const auto faces = core::FaceReader::open(grid.cells);
    if (!cells || !faces || !can_be_copied(*cells)) return out; // refining tells what is wrong
    ClosedGrid found{corners.grid, {}, {}, {}};
    describe_hanging(all->open, *covers, points, grid.points.type() == ScalarType::float32, found);
    out.report = found.report;
    out.report.open_faces = covers->open.size();
    if (covers->whole.empty()) return out;
    const auto list = [&] {
        std::vector<ListedCell> listed = list_cells(all->cells, all->faces, all->open, *covers, progress);
        for (ListedCell& cell : listed) cell.cell = corners.sources[cell.cell];
        return listed;
    };
    std::vector<ListedCell> listed = list();
    std::vector<std::uint64_t> numbers;
    for (const ListedCell& cell : listed) numbers.push_back(cell.cell);
    if (const auto nodes = own_nodes(*cells, numbers, covers->edges); !nodes.empty()) {
        covers->edges.add(nodes);
        listed = list();
    }
    out.report.cells = listed.size();
    std::vector<std::uint8_t> of_curved(grid.points.tuples());
    for (const ListedCell& cell : listed) {
        if (!is_curved(cells->type(cell.cell))) continue;
        ++out.report.curved_cells;
        for (const std::uint64_t point : cell.points) of_curved[point] = 1;
    }
    out.points = found.points;
    out.parents = found.parents;
    leave_out_points_of(of_curved, out);
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "looking for hanging points was cancelled"};
    progress("check", 0.8);
    auto made = with_listed_cells(*cells, *faces, listed, progress);
    if (!made) return made.error();
    out.grid.cells = *std::move(made);
    progress("check", 1);
    return out;
}

Result<ClosedGrid> close_hanging(const Grid& grid, const Progress& progress) {
    if (has_curved_cells(grid.cells)) return close_curved_cells(grid, progress);
    ClosedGrid out{grid, {}, {}, {}};
    const auto all = open_faces_of(grid, progress);
    if (!all) return all.error();
    progress("check", 0.6);
    const core::PointReader points(grid.points);
    const auto covers = find_covers(all->open, all->cells, points, progress);
    if (!covers) return covers.error();
    out.report.open_faces = covers->open.size();
    if (covers->whole.empty()) return out;
    describe_hanging(all->open, *covers, points, grid.points.type() == ScalarType::float32, out);
    const std::vector<ListedCell> listed = list_cells(all->cells, all->faces, all->open, *covers, progress);
    out.report.cells = listed.size();
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "looking for hanging points was cancelled"};
    progress("check", 0.8);
    auto made = with_listed_cells(all->cells, all->faces, listed, progress);
    if (!made) return made.error();
    out.grid.cells = *std::move(made);
    progress("check", 1);
    return out;
}

/// Calls use(point, component, the larger cell's value) in the order of hanging points. `values` may change meanwhile.
template <class T, class Use>
void each_interpolated(const ClosedGrid& closed, const std::vector<T>& values, std::size_t components, const Use& use) {
    if (closed.points.empty()) return;
    const auto points = closed.points.as<std::uint64_t>(), corners = closed.parents.points.as<std::uint64_t>();
    const auto first = closed.parents.first.as<std::uint64_t>();
    const auto weights = closed.parents.weights.as<double>();
    for (std::size_t row = 0; row < points.size(); ++row)
        for (std::size_t c = 0; c < components; ++c) {
            const std::size_t begin = first[row], count = first[row + 1] - begin;
            use(points[row], c,
                weighted_sum(
                    count, [&](std::size_t i) { return weights[begin + i]; },
                    [&](std::size_t i) { return static_cast<double>(values[corners[begin + i] * components + c]); }));
        }
}

Error wrong_tuples(const Array& values, std::size_t points) {
    return invalid_argument(
        fmt::format("the array has {} tuples, but the grid has {} points", values.tuples(), points));
}

} // namespace
} // namespace linear

Result<Array> ClosedGrid::interpolated(const Array& values, const Run& run) const {
    return core::carry_out("interpolating at hanging points", run, [&](const Progress&) -> Result<Array> {
        if (values.tuples() != grid.points.tuples()) return linear::wrong_tuples(values, grid.points.tuples());
        if (points.empty()) return values;
        return values.visit([&]<class T>(std::span<const T> from) {
            using To = std::conditional_t<std::is_floating_point_v<T>, T, double>;
            std::vector<To> to(from.begin(), from.end());
            const std::size_t components = values.components();
            linear::each_interpolated(*this, to, components, [&](std::uint64_t point, std::size_t c, double value) {
                to[point * components + c] = static_cast<To>(value);
            });
            return Array::own(std::move(to), components);
        });
    });
}

Result<double> ClosedGrid::largest_difference(const Array& values, const Run& run) const {
    const Result<Array> other = interpolated(values, run);
    if (!other) return other.error();
    double largest = 0;
    if (points.empty()) return largest;
    for (const std::uint64_t point : points.as<std::uint64_t>())
        for (std::size_t c = 0; c < values.components(); ++c)
            if (const double apart = std::abs(values.at(point, c) - other->at(point, c)); apart > largest)
                largest = apart;
    return largest;
}

std::vector<std::string> HangingReport::notes() const {
    std::vector<std::string> out;
    if (points > 0)
        out.push_back(fmt::format("{} points hang on faces or edges of larger cells: {} cells list them as polyhedra, "
                                  "so that the surface is closed there (docs/cells.md)",
                                  points, cells));
    if (curved_cells > 0)
        out.push_back(
            fmt::format("{} of these are cells above degree 1: they are linear between their points, without a "
                        "bound of the error, and hanging points have their own values",
                        curved_cells));
    if (near_faces > 0)
        out.push_back(fmt::format("hanging points of {} of {} faces are beside these, by up to {:.3g}: the surface "
                                  "follows the smaller cells",
                                  near_faces, faces, largest_distance));
    if (open_faces > 0)
        out.push_back(fmt::format("{} faces lie on smaller ones that do not cover them: the surface may be open there",
                                  open_faces));
    return out;
}

Result<ClosedGrid> close_hanging_points(const Grid& grid, const Run& run) {
    return core::carry_out("looking for hanging points", run,
                           [&](const Progress& progress) { return linear::close_hanging(grid, progress); });
}

} // namespace isotet
