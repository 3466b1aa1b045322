// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fields/expression/point_gradients.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include <isotet/linear_cells.hpp>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "grid/cells.hpp"
#include "grid/values/incidence.hpp"
#include "grid/orientation.hpp"

namespace isotet::core {

namespace {

/// The corners at the other ends of a corner's edges, around it; four at the tip of a pyramid.
struct Neighbours {
    std::uint8_t count = 0;
    std::array<std::uint8_t, 4> corners{};
};

constexpr auto neighbours_of_corners = [] {
    std::array<std::array<Neighbours, 8>, cell_kind_count> out{};
    for (const CellKind kind : cell_kinds)
        for (const auto& edge : edges_of(kind))
            for (std::size_t end = 0; end < 2; ++end) {
                Neighbours& list = out[static_cast<std::size_t>(kind)][edge[end]];
                list.corners[list.count++] = edge[1 - end];
            }
    return out;
}();

/// Derivatives at one corner: sums and how many were added.
class CornerSum {
public:
    explicit CornerSum(std::span<double> sum) : sum_(sum) { std::ranges::fill(sum, 0.0); }

    void add(const PointReader& points, std::span<const double> values, const WholeCell& cell, std::size_t corner) {
        const Neighbours& around = neighbours_of_corners[static_cast<std::size_t>(cell.kind)][corner];
        const std::size_t threes = around.count == 3 ? 1 : around.count;
        for (std::size_t first = 0; first < threes; ++first) {
            std::array<std::uint64_t, 3> ends{};
            for (std::size_t k = 0; k < 3; ++k) ends[k] = cell.corners[around.corners[(first + k) % around.count]];
            add_three(points, values, cell.corners[corner], ends, 1.0 / static_cast<double>(threes));
        }
    }

    void finish() {
        for (double& value : sum_) value = weight_ > 0 ? value / weight_ : std::numeric_limits<double>::quiet_NaN();
    }

private:
    void add_three(const PointReader& points, std::span<const double> values, std::uint64_t at,
                   const std::array<std::uint64_t, 3>& ends, double weight) {
        constexpr double flat = 1e-12; // of the product of the edges' lengths
        const std::size_t components = sum_.size() / 3;
        std::array<std::array<double, 3>, 3> edges{};
        double lengths = 1;
        const Point here = points[at];
        for (std::size_t k = 0; k < 3; ++k) {
            const Point there = points[ends[k]];
            for (std::size_t axis = 0; axis < 3; ++axis) edges[k][axis] = there[axis] - here[axis];
            lengths *= std::sqrt(dot(edges[k], edges[k]));
        }
        const std::array crosses{cross(edges[1], edges[2]), cross(edges[2], edges[0]), cross(edges[0], edges[1])};
        const double volume = dot(edges[0], crosses[0]);
        if (!(std::abs(volume) > flat * lengths)) return;
        for (std::size_t c = 0; c < components; ++c)
            for (const std::uint64_t end : ends)
                if (std::isnan(values[end * components + c] - values[at * components + c])) return;
        for (std::size_t c = 0; c < components; ++c)
            for (std::size_t k = 0; k < 3; ++k) {
                const double rise = values[ends[k] * components + c] - values[at * components + c];
                for (std::size_t axis = 0; axis < 3; ++axis)
                    sum_[3 * c + axis] += weight * (rise * crosses[k][axis] / volume);
            }
        weight_ += weight;
    }

    static double dot(const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }
    static std::array<double, 3> cross(const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    }

    std::span<double> sum_;
    double weight_ = 0;
};

template <class Index>
Result<Array> gradients(const CellReader& cells, const PointReader& points, const Array& values, std::size_t wanted,
                        const Progress& progress) {
    Incidence<Index> around(
        wanted, cells.count(),
        [&](std::size_t cell, const auto& body) {
            if (!is_contoured(cells.type(cell))) return;
            const std::uint64_t first = cells.first(cell), end = first + cells.corners(cell);
            for (std::uint64_t i = first; i < end; ++i)
                if (cells.corner(i) < wanted) body(cells.corner(i));
        },
        progress);
    const std::size_t width = 3 * values.components();
    const std::span<const double> all = values.as<double>();
    Buffer<double> out(wanted * width);
    parallel_pieces(wanted, std::size_t{1} << 12, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t point = begin; point < end; ++point) {
            const std::span<Index> list = around.of(point);
            std::ranges::sort(list);
            CornerSum sum({out.data() + point * width, width});
            for (std::size_t i = 0; i < list.size(); ++i) {
                if (i > 0 && list[i] == list[i - 1]) continue; // a collapsed cell has a point twice
                const WholeCell cell = cells.whole(list[i]);
                for (std::size_t corner = 0; corner < corner_count(cell.kind); ++corner)
                    if (cell.corners[corner] == point) sum.add(points, all, cell, corner);
            }
            sum.finish();
        }
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "computing derivatives was cancelled"};
    return std::move(out).to_array(width);
}

} // namespace

Result<Array> point_gradients(const Grid& grid, const Array& values, const Progress& progress) {
    Grid linear{grid.points, grid.cells, {}, {}, grid.point_numbers};
    Array extended = values;
    if (has_cells_to_linearize(grid.cells)) {
        const Run run{.progress = progress};
        auto made = linearize(linear, {}, run);
        if (!made) return made.error();
        auto continued = made->extend(values, run);
        if (!continued) return continued;
        linear = std::move(made->grid);
        extended = *std::move(continued);
    }
    const auto cells = CellReader::open(linear);
    if (!cells) return cells.error();
    if (auto sound = check_cells(linear, *cells, progress); !sound) return sound.error();
    const PointReader points(linear.points);
    const std::size_t wanted = grid.points.tuples();
    return cells->count() <= std::numeric_limits<std::uint32_t>::max()
               ? gradients<std::uint32_t>(*cells, points, extended, wanted, progress)
               : gradients<std::uint64_t>(*cells, points, extended, wanted, progress);
}

} // namespace isotet::core
