// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Space is cut into small cells, so small that all points of one are close to each other. A chain then runs from cell
// to cell, and the cells that it can reach in one step are at most two further along each axis.
#include "grid/points/close_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <tbb/parallel_sort.h>

#include "base/disjoint_sets.hpp"
#include "base/parallel.hpp"
#include "grid/orientation.hpp"

namespace isotet::core {

namespace {

using Cell = std::array<std::int64_t, 3>;

struct Placed {
    Cell cell;
    std::uint64_t point;
    auto operator<=>(const Placed&) const = default;
};

bool are_close(const Point& a, const Point& b, double tolerance) {
    const double x = (a[0] - b[0]) / tolerance, y = (a[1] - b[1]) / tolerance, z = (a[2] - b[2]) / tolerance;
    return x * x + y * y + z * z <= 1;
}

class Chains {
public:
    Chains(const Array& points, const std::vector<std::uint8_t>& wanted, const Point& lower, double tolerance)
        : points_(points), tolerance_(tolerance), sets_(points.tuples()) {
        // The diagonal of a cell is 0.06 % below the tolerance: room for the rounding of cell numbers up to 2^41.
        const double size = tolerance * 0.577;
        for (std::uint64_t point = 0; point < wanted.size(); ++point) {
            if (!wanted[point]) continue;
            const Point p = points_[point];
            Cell cell;
            for (std::size_t axis = 0; axis < 3; ++axis)
                cell[axis] = static_cast<std::int64_t>(std::floor((p[axis] - lower[axis]) / size));
            placed_.push_back({cell, point});
        }
        tbb::parallel_sort(placed_.begin(), placed_.end());
    }

    std::vector<std::uint64_t> lowest(const Progress& progress) {
        parallel_pieces(placed_.size(), 1 << 10, progress, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                if (i == 0 || placed_[i - 1].cell != placed_[i].cell) join_cell(i);
        });
        if (progress.cancelled()) return {};
        std::vector<std::uint64_t> result(sets_.size());
        parallel_each(result.size(), 1 << 14, [&](std::size_t point) { result[point] = sets_.root(point); });
        return result;
    }

private:
    /// The points of one cell, from its first on.
    std::span<const Placed> cell_from(std::size_t begin) const {
        std::size_t end = begin;
        while (end < placed_.size() && placed_[end].cell == placed_[begin].cell) ++end;
        return std::span(placed_).subspan(begin, end - begin);
    }

    /// Joins the points of the cell that begins at `begin` with each other and with those of the cells after it.
    void join_cell(std::size_t begin) {
        const std::span<const Placed> here = cell_from(begin);
        for (const Placed& other : here.subspan(1)) sets_.unite(here[0].point, other.point);
        const Cell cell = here[0].cell;
        auto place = placed_.begin() + static_cast<std::ptrdiff_t>(begin + here.size());
        for (std::int64_t x = 0; x <= 2; ++x)
            for (std::int64_t y = -2; y <= 2; ++y) {
                // Nearly always nothing of the plane is near, and its first search tells.
                const Cell last_of_plane{cell[0] + x, cell[1] + 2, cell[2] + 2};
                if (place == placed_.end() || (y > -2 && place->cell > last_of_plane)) break;
                const Cell first{cell[0] + x, cell[1] + y, cell[2] - 2}, last{cell[0] + x, cell[1] + y, cell[2] + 2};
                place = std::lower_bound(place, placed_.end(), first,
                                         [](const Placed& p, const Cell& c) { return p.cell < c; });
                while (place != placed_.end() && place->cell <= last) {
                    const auto there = cell_from(static_cast<std::size_t>(place - placed_.begin()));
                    join_cells(here, there);
                    place += static_cast<std::ptrdiff_t>(there.size());
                }
            }
    }

    /// One close pair is enough, as all points of a cell are already joined.
    void join_cells(std::span<const Placed> a, std::span<const Placed> b) {
        if (sets_.root(a[0].point) == sets_.root(b[0].point)) return;
        for (const Placed& p : a)
            for (const Placed& q : b)
                if (are_close(points_[p.point], points_[q.point], tolerance_)) {
                    sets_.unite(p.point, q.point);
                    return;
                }
    }

    PointReader points_;
    double tolerance_;
    DisjointSets<std::uint64_t> sets_;
    std::vector<Placed> placed_;
};

} // namespace

std::vector<std::uint64_t> lowest_of_chain(const Array& points, const std::vector<std::uint8_t>& wanted,
                                           const Point& lower, double tolerance, const Progress& progress) {
    return Chains(points, wanted, lower, tolerance).lowest(progress);
}

} // namespace isotet::core
