// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// merge_points(): a grid whose cells use one of several points at one place.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include <isotet/grid.hpp>

#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "grid/values/merged_values.hpp"
#include "grid/orientation.hpp"
#include "grid/patches.hpp"
#include "grid/points/close_points.hpp"
#include "grid/points/same_place.hpp"
#include "grid/points/used_points.hpp"

namespace isotet {

namespace {

constexpr std::size_t grain = 1 << 14;

Error cancelled() { return {ErrorCode::cancelled, "merging points was cancelled"}; }

/// True for cells whose points are merged: all three-dimensional ones that are contoured in some way.
bool is_merged(std::uint8_t type) { return core::is_contoured(type) || is_curved(type) || core::is_polyhedral(type); }

/// Checks what check_cells() leaves out: nodes of curved cells, corners and faces of polyhedra.
Result<void> check_other_cells(const Grid& grid, const core::CellReader& cells, const Progress& progress) {
    if (!has_cells_to_linearize(grid.cells)) return {};
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        if (core::is_contoured(cells.type(cell)) || !is_merged(cells.type(cell))) continue;
        const std::uint64_t first = cells.first(cell), count = cells.corners(cell);
        if (count > cells.connectivity_size() || first > cells.connectivity_size() - count)
            return invalid_data(fmt::format("cell {} has corners from {} on, {} of them, but the connectivity has {} "
                                            "entries",
                                            cell, first, count, cells.connectivity_size()));
        for (std::uint64_t i = first; i < first + count; ++i)
            if (cells.corner(i) >= cells.points())
                return invalid_data(fmt::format("cell {} has point {}, but the grid has {} points", cell,
                                                cells.corner(i), cells.points()));
    }
    return core::check_faces(grid, cells, progress);
}

struct Box {
    core::Point lower{}, upper{};
    double length() const { return std::max({upper[0] - lower[0], upper[1] - lower[1], upper[2] - lower[2]}); }
};

Box box_of(const Array& points, const std::vector<std::uint8_t>& used) {
    const core::PointReader reader(points);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (std::uint64_t point = 0; point < used.size(); ++point) {
        if (!used[point]) continue;
        const core::Point p = reader[point];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lower[axis] = std::min(box.lower[axis], p[axis]);
            box.upper[axis] = std::max(box.upper[axis], p[axis]);
        }
    }
    return box;
}

/// The connectivity with every point of these cells replaced; other cells stay as they are.
Array replaced(const Array& connectivity, const core::CellReader& cells, const std::vector<std::uint64_t>& lowest) {
    return connectivity.visit([&](auto old) -> Array {
        using Index = std::remove_const_t<typename decltype(old)::element_type>;
        core::Buffer<Index> numbers(old.size());
        core::parallel_ranges(old.size(), grain, [&](std::size_t begin, std::size_t end) {
            std::copy(old.begin() + static_cast<std::ptrdiff_t>(begin), old.begin() + static_cast<std::ptrdiff_t>(end),
                      numbers.data() + begin);
        });
        core::parallel_each(cells.count(), grain, [&](std::size_t cell) {
            if (!is_merged(cells.type(cell))) return;
            const std::uint64_t first = cells.first(cell), end = first + cells.corners(cell);
            for (std::uint64_t i = first; i < end; ++i) numbers[i] = static_cast<Index>(lowest[cells.corner(i)]);
        });
        return std::move(numbers).to_array();
    });
}

/// The faces of polyhedra with every point replaced; numbers of points stay.
Array replaced_faces(const Cells& all, const core::CellReader& cells, const std::vector<std::uint64_t>& lowest) {
    const auto faces = core::FaceReader::open(all).value();
    return all.faces.visit([&](auto old) -> Array {
        using Index = std::remove_const_t<typename decltype(old)::element_type>;
        core::Buffer<Index> numbers(old.size());
        std::ranges::copy(old, numbers.begin());
        core::parallel_each(cells.count(), grain, [&](std::size_t cell) {
            if (cells.type(cell) != core::polyhedron_type) return;
            for (std::uint64_t at = faces.begin(cell) + 1; at < faces.end(cell);) {
                const std::uint64_t end = at + 1 + faces.at(at);
                for (++at; at < end; ++at) numbers[at] = static_cast<Index>(lowest[faces.at(at)]);
            }
        });
        return std::move(numbers).to_array();
    });
}

struct CollapsedCells {
    std::uint64_t collapsed = 0, contoured = 0;
};

/// How many cells get two equal corners that were different points.
CollapsedCells count_collapsed(const core::CellReader& cells, const std::vector<std::uint64_t>& lowest) {
    std::atomic<std::uint64_t> collapsed = 0, contoured = 0;
    core::parallel_ranges(cells.count(), grain, [&](std::size_t begin, std::size_t end) {
        CollapsedCells part;
        for (std::size_t cell = begin; cell < end; ++cell) {
            if (!is_merged(cells.type(cell))) continue;
            ++part.contoured;
            constexpr std::uint64_t most_corners = 8; // of curved cells corners come first
            const std::uint64_t first = cells.first(cell), last = first + std::min(cells.corners(cell), most_corners);
            bool merged = false;
            for (std::uint64_t i = first; i < last && !merged; ++i)
                for (std::uint64_t j = first; j < i && !merged; ++j)
                    merged = cells.corner(i) != cells.corner(j) && lowest[cells.corner(i)] == lowest[cells.corner(j)];
            part.collapsed += merged;
        }
        collapsed += part.collapsed;
        contoured += part.contoured;
    });
    return {collapsed, contoured};
}

Result<MergedPoints> merge(const Grid& grid, const MergeOptions& options, const Progress& progress) {
    const double tolerance = options.tolerance;
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto sound = core::check_cells(grid, *cells, progress); !sound) return sound.error();
    if (auto sound = check_other_cells(grid, *cells, progress); !sound) return sound.error();
    if (auto sound = core::check_patches(grid); !sound) return sound.error();
    progress("merge points", 0.2);
    const std::vector<std::uint8_t> used =
        core::points_of_cells(*cells, [&](std::size_t cell) { return is_merged(cells->type(cell)); });
    std::vector<std::uint64_t> lowest;
    if (tolerance > 0) {
        const Box box = box_of(grid.points, used);
        if (box.length() > 0x1p40 * tolerance)
            return Error{ErrorCode::invalid_argument,
                         fmt::format("the tolerance is {}, but for a grid of length {} it must be 0 or at least {}",
                                     tolerance, box.length(), 0x1p-40 * box.length())};
        lowest = core::lowest_of_chain(grid.points, used, box.lower, tolerance, progress);
    } else {
        lowest = core::lowest_at_same_place(grid.points, used.data());
    }
    if (progress.cancelled()) return cancelled();
    progress("merge points", 0.8);

    MergedPoints result{grid, 0, 0, {}};
    for (std::uint64_t point = 0; point < lowest.size(); ++point) result.merged += lowest[point] != point;
    if (result.merged > 0) {
        const CollapsedCells cells_hit = count_collapsed(*cells, lowest);
        if (tolerance > 0 && cells_hit.collapsed == cells_hit.contoured)
            return Error{ErrorCode::invalid_argument,
                         fmt::format("the tolerance is {}, but with it every one of the {} cells collapses: it must be "
                                     "below the length of their edges",
                                     tolerance, cells_hit.contoured)};
        result.collapsed_cells = cells_hit.collapsed;
        result.grid.cells.connectivity = replaced(grid.cells.connectivity, *cells, lowest);
        result.grid.patches = core::renumbered(
            grid.patches, [&](std::uint64_t point) { return static_cast<std::int64_t>(lowest[point]); });
        if (!grid.cells.faces.empty()) result.grid.cells.faces = replaced_faces(grid.cells, *cells, lowest);
    }
    for (Field& field : result.grid.point_fields) {
        result.jumps.push_back({field.name, core::largest_jump(field.values, lowest)});
        if (options.values == MergedValues::mean && result.merged > 0)
            field.values = core::with_means(field.values, lowest);
        if (progress.cancelled()) return cancelled();
    }
    progress("merge points", 1);
    return result;
}

} // namespace

Result<MergedPoints> merge_points(const Grid& grid, const MergeOptions& options, const Run& run) {
    if (!(options.tolerance >= 0) || std::isinf(options.tolerance))
        return invalid_argument(
            fmt::format("the tolerance is {}, but must be finite and not negative", options.tolerance));
    if (run.progress.cancelled()) return cancelled();
    return core::carry_out("merging points", run,
                           [&](const Progress& progress) { return merge(grid, options, progress); });
}

} // namespace isotet
