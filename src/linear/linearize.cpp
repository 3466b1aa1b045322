// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/linear_cells.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include <fmt/core.h>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "grid/cell_faces.hpp"
#include "linear/by_numbers.hpp"
#include "linear/curved/curved_kinds.hpp"
#include "linear/curved/high_degree.hpp"
#include "linear/curved/quadratic.hpp"
#include "linear/curved/refine.hpp"
#include "linear/parts.hpp"
#include "linear/polyhedra/polyhedron.hpp"

namespace isotet {

namespace linear {

namespace {

/// Cells that are split together: their arrays fill huge pages in large grids, and all threads have work in small ones.
std::size_t cells_of_block(std::size_t cells) { return std::clamp<std::size_t>(cells / 128, 1024, 16384); }

Error linearizing_cancelled() { return {ErrorCode::cancelled, "making linear cells was cancelled"}; }

/// A cell that stays as it is.
void keep_cell(const core::CellReader& cells, std::size_t cell, std::vector<std::uint64_t>& corners, Parts& out) {
    corners.clear();
    const std::uint64_t first = cells.first(cell), count = cells.corners(cell);
    for (std::uint64_t i = 0; i < count; ++i) corners.push_back(cells.corner(first + i));
    out.add_cell(cells.type(cell), corners, cell);
}

/// Nothing can be contoured: says why.
Error nothing_left(const Grid& grid, const LinearizeReport& report) {
    return invalid_data(
        fmt::format("the grid with {} points and {} cells has no cell that can be contoured: the faces of "
                    "{} of its {} polyhedra do not close",
                    grid.points.tuples(), grid.cells.count(), report.open, report.polyhedra));
}

Result<void> check_high_degree(const Grid& grid, const core::CellReader& cells, const Progress& progress) {
    std::atomic<std::size_t> lowest{cells.count()};
    core::parallel_pieces(cells.count(), 1 << 12, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t cell = begin; cell < end && cell < lowest.load(std::memory_order_relaxed); ++cell) {
            if (!high_degree_of(cells.type(cell), cells.corners(cell))) continue;
            if (fault_of_high_degree(grid, cells, cell).empty()) continue;
            std::size_t seen = lowest.load(std::memory_order_relaxed);
            while (cell < seen && !lowest.compare_exchange_weak(seen, cell, std::memory_order_relaxed)) {}
        }
    });
    if (lowest.load() < cells.count()) return invalid_data(fault_of_high_degree(grid, cells, lowest.load()));
    return {};
}

/// Which polyhedra have values on both sides of an isovalue, or one that is not finite.
class MetCells {
public:
    MetCells(const core::CellReader& cells, const LinearizeOptions& options)
        : cells_(cells), values_(options.values), isovalues_(options.isovalues) {
        std::ranges::sort(isovalues_);
    }

    /// `corner_values`   memory to be used again
    bool meets(std::size_t cell, std::vector<double>& corner_values) const {
        const std::uint64_t first = cells_.first(cell), count = cells_.corners(cell);
        corner_values.resize(count);
        values_.visit([&](auto values) {
            for (std::uint64_t i = 0; i < count; ++i)
                corner_values[i] = static_cast<double>(values[cells_.corner(first + i)]);
        });
        double lower = INFINITY, upper = -INFINITY;
        bool finite = true;
        for (const double value : corner_values) {
            finite &= std::isfinite(value);
            lower = std::min(lower, value);
            upper = std::max(upper, value);
        }
        if (!finite) return true;
        // The nearest stored value of an isovalue counts, so a little more than the range.
        constexpr double rounding = 0x1p-20;
        const double more = rounding * std::max(std::abs(lower), std::abs(upper));
        const auto next = std::ranges::lower_bound(isovalues_, lower - more);
        return next != isovalues_.end() && *next <= upper + more;
    }

private:
    const core::CellReader& cells_;
    const Array& values_;
    std::vector<double> isovalues_;
};

Result<void> check_selection(const Grid& grid, const LinearizeOptions& options) {
    if (options.isovalues.empty()) return {};
    if (options.values.tuples() != grid.points.tuples() || options.values.components() != 1)
        return invalid_argument(fmt::format("there are {} values of {} components, but the grid has {} points and one "
                                            "scalar a point is needed",
                                            options.values.tuples(), options.values.components(),
                                            grid.points.tuples()));
    if (!grid.point_numbers.empty() || has_curved_cells(grid.cells))
        return invalid_argument(
            "polyhedra are chosen by isovalues only in grids without curved cells and point numbers");
    return {};
}

/// Where numbers decide, they are the indices of points.
Result<LinearGrid> split_in_order(const Grid& grid, const LinearizeOptions& options, const Progress& progress) {
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto fits = check_selection(grid, options); !fits) return fits.error();
    if (auto sound = core::check_cells(grid, *cells, progress); !sound) return sound.error();
    if (auto sound = core::check_faces(grid, *cells, progress); !sound) return sound.error();
    const auto faces = core::FaceReader::open(grid.cells);
    if (!faces) return faces.error();
    const bool high_degree = has_high_degree(*cells);
    if (high_degree)
        if (auto sound = check_high_degree(grid, *cells, progress); !sound) return sound.error();
    progress("linearize", 0.1);

    const bool narrow = grid.points.tuples() < std::uint64_t{1} << 31;
    const MetCells met(*cells, options);
    const std::size_t cells_per_block = cells_of_block(cells->count());
    std::vector<KeptParts> blocks((cells->count() + cells_per_block - 1) / cells_per_block);
    core::parallel_ranges(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
        PolyhedronSplitter splitter(grid, *cells, *faces, options);
        HighDegreeSplitter by_degree(*cells);
        std::vector<std::uint64_t> corners;
        std::vector<double> corner_values;
        Parts parts;
        for (std::size_t b = begin; b < end && !progress.cancelled(); ++b) {
            const std::size_t last = std::min(cells->count(), (b + 1) * cells_per_block);
            for (std::size_t cell = b * cells_per_block; cell < last; ++cell) {
                const bool is_polyhedron = core::is_polyhedron(*cells, *faces, cell);
                if (is_polyhedron && !options.isovalues.empty() && !met.meets(cell, corner_values) &&
                    !std::ranges::binary_search(options.also, cell))
                    ++parts.report.unmet;
                else if (is_polyhedron) splitter.split(cell, parts);
                else if (const auto what = high_degree_of(cells->type(cell), cells->corners(cell)))
                    by_degree.split(cell, *what, parts);
                else keep_cell(*cells, cell, corners, parts);
            }
            blocks[b] = KeptParts(parts, narrow);
        }
    });
    if (progress.cancelled()) return linearizing_cancelled();
    progress("linearize", 0.8);
    LinearGrid out = joined(blocks, grid.points.tuples());
    out.user_cells = cells->count();
    if (high_degree) merge_rows(out);
    const auto types = out.grid.cells.types.as<std::uint8_t>();
    if (out.report.unmet == 0 && std::ranges::none_of(types, core::is_contoured) && !has_curved_cells(grid.cells))
        return nothing_left(grid, out.report);
    auto points = out.extend(grid.points, {.threads = core::threads_here()});
    if (!points) return points.error();
    out.grid.points = *std::move(points);
    progress("linearize", 1);
    return out;
}

} // namespace

Result<LinearGrid> split_polyhedra(const Grid& user, const LinearizeOptions& options, const Progress& progress) {
    const Grid grid{user.points, user.cells, {}, {}, user.point_numbers};
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    const bool high_degree = has_curved_cells(grid.cells) && has_high_degree(*cells);
    if (!has_polyhedra(grid.cells) && !high_degree) {
        LinearGrid same;
        same.grid = grid;
        same.user_points = grid.points.tuples();
        same.user_cells = cells->count();
        return same;
    }
    if (grid.point_numbers.empty()) return split_in_order(grid, options, progress);
    const auto sorted = sort_by_numbers(grid, progress);
    if (!sorted) return sorted.error();
    auto linear = split_in_order(sorted->grid, options, progress);
    if (!linear) return linear.error();
    return in_users_order(*std::move(linear), grid, sorted->original);
}

namespace {

/// True when a cell is of a type for which `wanted` is true.
bool has_type(const Cells& cells, const auto& wanted) {
    if (cells.types.empty() || cells.types.type() != ScalarType::uint8) return false;
    const auto types = cells.types.as<std::uint8_t>();
    std::atomic<bool> found{false};
    core::parallel_ranges(types.size(), 1 << 18, [&](std::size_t begin, std::size_t end) {
        if (std::ranges::any_of(types.subspan(begin, end - begin), wanted))
            found.store(true, std::memory_order_relaxed);
    });
    return found;
}

/// True for the types of polyhedra that the grid has faces of.
auto is_split_by_faces(const Cells& cells) {
    return [listed = !cells.faces.empty()](std::uint8_t type) {
        return (listed && type == core::polyhedron_type) || core::prism_sides(type) > 0;
    };
}

} // namespace

bool has_polyhedra(const Cells& cells) { return has_type(cells, is_split_by_faces(cells)); }

Result<LinearGrid> linearize(const Grid& grid, const LinearizeOptions& options, const Progress& progress) {
    auto split = split_polyhedra(grid, options, progress);
    if (!split || !has_curved_cells(grid.cells)) return split;
    return refined(grid, *std::move(split), nullptr, {}, progress);
}

} // namespace linear

bool is_curved(std::uint8_t vtk_type) noexcept { return linear::is_curved(vtk_type); }

bool has_curved_cells(const Cells& cells) { return linear::has_type(cells, linear::is_curved); }

bool has_cells_to_linearize(const Cells& cells) {
    return linear::has_type(cells, [by_faces = linear::is_split_by_faces(cells)](std::uint8_t type) {
        return by_faces(type) || linear::is_curved(type);
    });
}

Result<LinearGrid> linearize(const Grid& grid, const LinearizeOptions& options, const Run& run) {
    return core::carry_out("making linear cells", run,
                           [&](const Progress& progress) { return linear::linearize(grid, options, progress); });
}

} // namespace isotet
