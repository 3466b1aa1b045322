// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/linear_cells.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "grid/cell/curved_types.hpp"
#include "grid/cell_faces.hpp"
#include "linear/by_numbers.hpp"
#include "linear/curved/curved_kinds.hpp"
#include "linear/curved/high_degree.hpp"
#include "linear/curved/lattice_faces.hpp"
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
    MetCells(const core::CellReader& cells, const LinearizeOptions& options, const Progress& progress)
        : cells_(cells), values_(options.values), isovalues_(options.isovalues) {
        std::ranges::sort(isovalues_);
        if (options.around && !isovalues_.empty()) mark_points(progress);
    }

    /// Whether a corner is one of a cell that is met; false where none are marked.
    bool is_around(std::size_t cell) const {
        for (std::uint64_t i = 0; i < cells_.corners(cell) && !marked_.empty(); ++i)
            if (marked_[cells_.corner(cells_.first(cell) + i)]) return true;
        return false;
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
    void mark_points(const Progress& progress) {
        marked_ = core::Buffer<std::uint8_t>(cells_.points());
        std::ranges::fill(marked_, std::uint8_t{0});
        core::parallel_pieces(cells_.count(), 1 << 13, progress, [&](std::size_t begin, std::size_t end) {
            std::vector<double> corner_values;
            for (std::size_t cell = begin; cell < end; ++cell) {
                if (!meets(cell, corner_values)) continue;
                for (std::uint64_t i = 0; i < cells_.corners(cell); ++i)
                    std::atomic_ref(marked_[cells_.corner(cells_.first(cell) + i)]).store(1, std::memory_order_relaxed);
            }
        });
    }

    const core::CellReader& cells_;
    const Array& values_;
    std::vector<double> isovalues_;
    core::Buffer<std::uint8_t> marked_; ///< by point
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

/// Of the derived points of blocks their numbers among those of all cells.
class RowNumbers {
public:
    explicit RowNumbers(std::size_t blocks) : numbers_(blocks), rows_(blocks) {}

    /// When a cell of a block was kept, whose rows are now so many, or left out with so many rows.
    void keep(std::size_t block, std::size_t rows) {
        while (numbers_[block].size() < rows) numbers_[block].push_back(rows_[block]++);
    }
    void leave_out(std::size_t block, std::size_t rows) { rows_[block] += rows; }

    Array join(std::uint64_t user_points) && {
        std::vector<std::uint64_t> all;
        std::uint64_t first = user_points;
        for (std::size_t block = 0; block < numbers_.size(); first += rows_[block++])
            for (const std::uint64_t number : numbers_[block]) all.push_back(first + number);
        return Array::own(std::move(all));
    }

private:
    std::vector<std::vector<std::uint64_t>> numbers_;
    std::vector<std::uint64_t> rows_;
};

/// `polyhedra`   nothing: they stay for later, without their faces
LinearGrid split_blocks(const Grid& grid, const core::CellReader& cells, const core::FaceReader& faces,
                        const LinearizeOptions& options, std::optional<LargeFaces> polyhedra,
                        const Progress& progress) {
    const bool narrow = grid.points.tuples() < std::uint64_t{1} << 31;
    const MetCells met(cells, options, progress);
    const std::size_t cells_per_block = cells_of_block(cells.count());
    std::vector<KeptParts> blocks((cells.count() + cells_per_block - 1) / cells_per_block);
    RowNumbers numbers(blocks.size());
    core::parallel_ranges(blocks.size(), 1, [&](std::size_t begin, std::size_t end) {
        PolyhedronSplitter splitter(grid, cells, faces, options, polyhedra.value_or(LargeFaces::quadrilaterals));
        HighDegreeSplitter by_degree(cells);
        std::vector<double> corner_values;
        Parts parts, left_out;
        for (std::size_t b = begin; b < end && !progress.cancelled(); ++b) {
            const std::size_t last = std::min(cells.count(), (b + 1) * cells_per_block);
            for (std::size_t cell = b * cells_per_block; cell < last; ++cell) {
                const bool is_split = polyhedra && core::is_polyhedron(cells, faces, cell);
                if (is_split && !options.isovalues.empty() && !met.meets(cell, corner_values) && !met.is_around(cell) &&
                    !std::ranges::binary_search(options.also, cell)) {
                    ++parts.report.unmet;
                    if (!options.numbers) continue;
                    splitter.split(cell, left_out);
                    numbers.leave_out(b, left_out.rows());
                    left_out.clear();
                } else if (is_split) splitter.split(cell, parts);
                else if (const auto what = high_degree_of(cells.type(cell), cells.corners(cell)))
                    by_degree.split(cell, *what, parts);
                else parts.keep_cell(cells, cell);
                if (options.numbers) numbers.keep(b, parts.rows());
            }
            blocks[b] = KeptParts(parts, narrow);
        }
    });
    if (progress.cancelled()) return {};
    LinearGrid out = joined(blocks, grid.points.tuples());
    out.user_cells = cells.count();
    if (options.numbers) out.derived_numbers = std::move(numbers).join(grid.points.tuples());
    if (out.report.high_degree > 0) merge_rows(out);
    return out;
}

/// Rows of weights of a grid's points, some of which are derived, as of the user's points, behind the rows of these.
DerivedPoints composed_rows(const LinearGrid& before, const DerivedPoints& rows) {
    std::vector<std::uint64_t> first{0}, points;
    std::vector<double> weights;
    std::vector<std::pair<std::uint64_t, double>> terms;
    const auto add = [&](const DerivedPoints& from, std::uint64_t row, double share, const auto& use) {
        const auto ends = from.first.as<std::uint64_t>(), of = from.points.as<std::uint64_t>();
        const std::uint64_t count = ends[row + 1] - ends[row];
        for (std::uint64_t i = ends[row]; i < ends[row + 1]; ++i)
            use(of[i], share * (from.weights.empty() ? 1 / static_cast<double>(count) : from.weights.as<double>()[i]));
    };
    const auto put = [&](std::uint64_t point, double weight) {
        points.push_back(point);
        weights.push_back(weight);
    };
    for (std::uint64_t row = 0; row < before.derived.count(); ++row) {
        add(before.derived, row, 1, put);
        first.push_back(points.size());
    }
    for (std::uint64_t row = 0; row < rows.count(); ++row) {
        terms.clear();
        const auto put_term = [&](std::uint64_t point, double weight) { terms.emplace_back(point, weight); };
        add(rows, row, 1, [&](std::uint64_t point, double weight) {
            if (point < before.user_points) put_term(point, weight);
            else add(before.derived, point - before.user_points, weight, put_term);
        });
        std::ranges::sort(terms);
        for (std::size_t i = 0; i < terms.size(); ++i)
            if (i > 0 && terms[i].first == terms[i - 1].first) weights.back() += terms[i].second;
            else put(terms[i].first, terms[i].second);
        first.push_back(points.size());
    }
    return {Array::own(std::move(first)), Array::own(std::move(points)), Array::own(std::move(weights))};
}

/// Without points.
LinearGrid composed(const LinearGrid& before, LinearGrid&& after) {
    LinearGrid out = std::move(after);
    out.derived = composed_rows(before, out.derived);
    out.user_points = before.user_points;
    out.user_cells = before.user_cells;
    const auto users = before.source_cells.as<std::uint64_t>();
    if (out.source_cells.empty()) {
        out.source_cells = before.source_cells;
    } else {
        const auto parts = out.source_cells.as<std::uint64_t>();
        core::Buffer<std::uint64_t> sources(parts.size());
        core::parallel_each(parts.size(), 1 << 14, [&](std::size_t i) { sources[i] = users[parts[i]]; });
        out.source_cells = std::move(sources).to_array();
    }
    out.report.high_degree = before.report.high_degree;
    out.report.high_degree_parts = before.report.high_degree_parts;
    return out;
}

Result<LinearGrid> split_in_order(const Grid& grid, const LinearizeOptions& options, LargeFaces large,
                                  const Progress& progress);

/// Cells of degree 3 and above first, then polyhedra, which have their points on common edges and faces.
Result<LinearGrid> split_by_degree_first(const Grid& grid, const core::CellReader& cells, const core::FaceReader& faces,
                                         const LinearizeOptions& options, const Progress& progress) {
    LinearGrid quadratic = split_blocks(grid, cells, faces, options, std::nullopt, progress);
    if (progress.cancelled()) return linearizing_cancelled();
    auto points = quadratic.extend(grid.points);
    if (!points) return points.error();
    quadratic.grid.points = *std::move(points);
    auto listed = with_lattice_faces(cells, faces, quadratic, progress);
    if (!listed) return listed.error();
    quadratic.grid.cells = *std::move(listed);
    auto linear = split_in_order(quadratic.grid, options, LargeFaces::triangles, progress);
    if (!linear) return linear;
    LinearGrid out = composed(quadratic, *std::move(linear));
    points = out.extend(grid.points);
    if (!points) return points.error();
    out.grid.points = *std::move(points);
    return out;
}

/// Where numbers decide, they are the indices of points.
Result<LinearGrid> split_in_order(const Grid& grid, const LinearizeOptions& options, LargeFaces large,
                                  const Progress& progress) {
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

    if (high_degree && has_polyhedra_at_lattices(*cells, *faces))
        return split_by_degree_first(grid, *cells, *faces, options, progress);
    LinearGrid out = split_blocks(grid, *cells, *faces, options, large, progress);
    if (progress.cancelled()) return linearizing_cancelled();
    progress("linearize", 0.8);
    const auto types = out.grid.cells.types.as<std::uint8_t>();
    if (out.report.unmet == 0 && std::ranges::none_of(types, core::is_contoured) && !has_curved_cells(grid.cells))
        return nothing_left(grid, out.report);
    auto points = out.extend(grid.points);
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
    if (grid.point_numbers.empty()) return split_in_order(grid, options, LargeFaces::quadrilaterals, progress);
    const auto sorted = sort_by_numbers(grid, progress);
    if (!sorted) return sorted.error();
    auto linear = split_in_order(sorted->grid, options, LargeFaces::quadrilaterals, progress);
    if (!linear) return linear.error();
    return in_users_order(*std::move(linear), grid, sorted->original);
}

Result<LinearGrid> linearize(const Grid& grid, const LinearizeOptions& options, const Progress& progress) {
    auto split = split_polyhedra(grid, options, progress);
    if (!split || !has_curved_cells(grid.cells)) return split;
    return refined(grid, *std::move(split), nullptr, {}, progress);
}

} // namespace linear

Result<LinearGrid> linearize(const Grid& grid, const LinearizeOptions& options, const Run& run) {
    return core::carry_out("making linear cells", run,
                           [&](const Progress& progress) { return linear::linearize(grid, options, progress); });
}

} // namespace isotet
