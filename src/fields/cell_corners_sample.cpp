// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fields/cell_corners_sample.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "grid/cells.hpp"
#include "grid/values/scalar_of.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t most_runs = 64, cells_of_run = 256;

/// Somewhere in the run's part of the cells: even steps may all lie in one column of a regular grid.
std::size_t begin_of_run(std::size_t run, std::size_t runs, std::size_t cells) {
    const auto begin_of_part = [&](std::size_t part) { return cells / runs * part + cells % runs * part / runs; };
    const std::size_t begin = begin_of_part(run), size = begin_of_part(run + 1) - begin;
    const std::size_t free = size - std::min(size, cells_of_run);
    const std::size_t share =
        static_cast<std::uint32_t>(run * 0x9E3779B1U) >> 16U; // of 2^16: steps of the golden ratio
    return begin + (free >> 16) * share + ((free & 0xFFFF) * share >> 16);
}

/// Variance within groups as a share of that over all. `value(item)` may be NaN: the item is passed over.
template <class Items, class Value>
double share_of_variance(const Items& groups, const Value& value) {
    double all_sum = 0, scale = 0;
    std::size_t all = 0;
    for (const std::uint64_t item : groups.items) {
        const double x = value(item);
        if (!std::isfinite(x)) continue;
        scale = std::max(scale, std::abs(x));
        ++all;
    }
    if (all < 3 || scale == 0) return 0;
    for (const std::uint64_t item : groups.items)
        if (const double x = value(item); std::isfinite(x)) all_sum += x / scale;
    const double all_mean = all_sum / static_cast<double>(all);
    double all_squares = 0, within = 0;
    std::size_t freedom = 0;
    for (std::size_t g = 0; g + 1 < groups.first.size(); ++g) {
        double sum = 0;
        std::size_t count = 0;
        for (std::size_t i = groups.first[g]; i < groups.first[g + 1]; ++i)
            if (const double x = value(groups.items[i]) / scale; std::isfinite(x)) {
                sum += x;
                ++count;
            }
        if (count == 0) continue;
        const double mean = sum / static_cast<double>(count);
        for (std::size_t i = groups.first[g]; i < groups.first[g + 1]; ++i)
            if (const double x = value(groups.items[i]) / scale; std::isfinite(x)) {
                within += (x - mean) * (x - mean);
                all_squares += (x - all_mean) * (x - all_mean);
            }
        freedom += count - 1;
    }
    if (freedom == 0 || !(all_squares > 0)) return 0;
    return (within / static_cast<double>(freedom)) / (all_squares / static_cast<double>(all - 1));
}

} // namespace

std::vector<std::pair<std::uint64_t, std::uint64_t>> cells_to_sample(std::uint64_t cells) {
    if (cells <= most_runs * cells_of_run) return {{0, cells}};
    std::vector<std::pair<std::uint64_t, std::uint64_t>> runs;
    for (std::size_t run = 0; run < most_runs; ++run) {
        const std::uint64_t begin = begin_of_run(run, most_runs, cells);
        runs.emplace_back(begin, begin + cells_of_run);
    }
    return runs;
}

CellCornersSample::CellCornersSample(const Grid& grid, std::span<const std::uint64_t> numbers) {
    const Grid bare{grid.points, grid.cells, {}, {}, {}};
    const auto cells = CellReader::open(bare);
    if (!cells || cells->count() == 0) return;
    const std::size_t runs = std::min(most_runs, (cells->count() + cells_of_run - 1) / cells_of_run);
    std::vector<std::pair<std::uint64_t, std::uint64_t>> uses; // point, cell
    for (std::size_t run = 0; run < runs; ++run) {
        const std::size_t begin = begin_of_run(run, runs, cells->count());
        const std::size_t end = std::min(begin + cells_of_run, cells->count());
        uses.clear();
        for (std::size_t cell = begin; cell < end; ++cell) {
            if (cells->has_types() && cells->type(cell) < static_cast<std::uint8_t>(CellType::tetrahedron)) continue;
            const std::uint64_t first = cells->first(cell), next = cells->first(cell + 1);
            if (next < first || next > cells->connectivity_size()) continue;
            for (std::uint64_t i = first; i < next; ++i)
                if (const std::uint64_t point = cells->corner(i); point < cells->points()) {
                    points_of_cells_.items.push_back(point);
                    uses.emplace_back(point, cell < numbers.size() ? numbers[cell] : cell);
                }
            points_of_cells_.first.push_back(points_of_cells_.items.size());
        }
        std::ranges::sort(uses);
        for (std::size_t i = 0; i < uses.size(); ++i) {
            if (i > 0 && uses[i].first != uses[i - 1].first)
                cells_of_points_.first.push_back(cells_of_points_.items.size());
            cells_of_points_.items.push_back(uses[i].second);
        }
        cells_of_points_.first.push_back(cells_of_points_.items.size());
    }
    measure_cells(grid.points);
}

void CellCornersSample::measure_cells(const Array& points) {
    constexpr double all_of_it = 0.75, few_of_it = 0.1;
    if (points.components() != 3) return;
    std::array<double, 3> share{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto coordinate = [&](std::uint64_t point) { return points.at(point, axis); };
        linear_ = std::max(linear_, share_of_variance(points_of_cells_, coordinate));
        double lower = std::numeric_limits<double>::infinity(), upper = -lower, extents = 0;
        for (std::size_t g = 0; g + 1 < points_of_cells_.first.size(); ++g) {
            double low = std::numeric_limits<double>::infinity(), high = -low;
            for (std::size_t i = points_of_cells_.first[g]; i < points_of_cells_.first[g + 1]; ++i) {
                const double x = coordinate(points_of_cells_.items[i]);
                low = std::min(low, x);
                high = std::max(high, x);
            }
            if (!(low <= high)) continue;
            lower = std::min(lower, low);
            upper = std::max(upper, high);
            extents += high - low;
        }
        const auto cells = static_cast<double>(points_of_cells_.first.size() - 1);
        share[axis] = upper > lower ? extents / cells / (upper - lower) : 1;
    }
    std::ranges::sort(share);
    thin_ = share[2] >= all_of_it && share[1] <= few_of_it;
}

double CellCornersSample::roughness(const Array& values, Association association) const {
    const Groups& groups = association == Association::point ? points_of_cells_ : cells_of_points_;
    const Scalar scalar{0, values.components() > 1};
    return share_of_variance(groups, [&](std::uint64_t item) {
        return item < values.tuples() ? scalar_at(values, scalar, item) : std::numeric_limits<double>::quiet_NaN();
    });
}

bool CellCornersSample::has_values(const Array& values, Association association) const {
    const Groups& groups = association == Association::point ? points_of_cells_ : cells_of_points_;
    const Scalar scalar{0, values.components() > 1};
    return groups.items.empty() || std::ranges::any_of(groups.items, [&](std::uint64_t item) {
               return item < values.tuples() && std::isfinite(scalar_at(values, scalar, item));
           });
}

} // namespace isotet::core
