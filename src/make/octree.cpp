// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "make/octree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/buffer.hpp"
#include "base/system/memory.hpp"
#include "base/until_cancelled.hpp"
#include "make/analytic_field.hpp"
#include "make/cube_cells.hpp"
#include "make/random.hpp"

namespace isotet::make {

namespace {

using Steps = std::array<std::uint64_t, 3>; ///< along the axes, in quarters of a cube

constexpr std::uint64_t finest = 4; ///< smallest cubes along an edge of a largest one
constexpr double radius_of_cuts = 0.6;
constexpr double reach_of_corners = 0.15; ///< of a cube's edge

/// A cube that is not cut.
struct Uncut {
    Steps lowest;
    std::uint64_t edge;
};

class Octree {
public:
    Octree(const OctreeShape& shape, const MakeOptions& options, const Progress& progress)
        : shape_(shape), options_(options), progress_(progress), side_(options.side), row_(finest * side_ + 1) {}

    Result<Grid> make() {
        count_leaves();
        const std::uint64_t leaves = first_.back(), corners = leaves * corners_per_leaf();
        const std::uint64_t bytes =
            leaves * 8 * sizeof(std::uint64_t) + corners * 4 + leaves * (12 + 4 * options_.fields.size());
        if (auto fits = core::require_memory("making the grid", bytes); !fits) return fits.error();
        if (!step(0.2)) return stopped();
        number_points();
        if (!step(0.6)) return stopped();
        if (keys_.size() > std::uint64_t{std::numeric_limits<std::int32_t>::max()})
            return Error{ErrorCode::invalid_argument, "the grid would have more than 2^31 points: a smaller side"};
        Grid grid;
        grid.points = points();
        grid.cells.connectivity = connectivity();
        grid.cells.uniform_type = shape_.leaf == Leaf::hexahedron ? CellType::hexahedron : CellType::tetrahedron;
        if (!step(0.8)) return stopped();
        for (const std::string& name : options_.fields) {
            if (progress_.cancelled()) return stopped();
            grid.point_fields.push_back({name, field(name)});
        }
        if (!step(1)) return stopped();
        return grid;
    }

private:
    static Error stopped() { return {ErrorCode::cancelled, "making the grid was cancelled"}; }
    bool step(double done) const {
        progress_("make", done);
        return !progress_.cancelled();
    }

    std::uint64_t cubes() const { return side_ * side_ * side_; }
    std::size_t corners_per_leaf() const { return shape_.leaf == Leaf::hexahedron ? 8 : 24; }
    double coordinate(std::uint64_t steps) const {
        return (2 * static_cast<double>(steps) - static_cast<double>(finest * side_)) /
               static_cast<double>(finest * side_);
    }

    /// `number`   of the cube: 0 to 8 for one of the largest and its eight
    bool is_cut(const Uncut& cube, std::uint64_t number) const {
        if (shape_.cut == Cut::at_random)
            return draw(options_.seed, Stream::refinement, number) % (cube.edge == finest ? 2 : 4) == 0;
        double nearest = 0, farthest = 0;
        for (const std::uint64_t lower : cube.lowest) {
            const double a = coordinate(lower), b = coordinate(lower + cube.edge);
            const double far = std::max(std::abs(a), std::abs(b));
            const double near = a <= 0 && b >= 0 ? 0 : std::min(std::abs(a), std::abs(b));
            nearest += near * near;
            farthest += far * far;
        }
        constexpr double square = radius_of_cuts * radius_of_cuts;
        return nearest <= square && square <= farthest;
    }

    static Uncut eighth(const Uncut& cube, std::uint64_t number) {
        Uncut out{cube.lowest, cube.edge / 2};
        for (std::size_t axis = 0; axis < 3; ++axis) out.lowest[axis] += (number >> axis & 1) * out.edge;
        return out;
    }

    /// Calls use(leaf) for the leaves of one of the largest cubes.
    template <class Use>
    void each_leaf(std::uint64_t cube, const Use& use) const {
        const Uncut whole{{finest * (cube % side_), finest * (cube / side_ % side_), finest * (cube / (side_ * side_))},
                          finest};
        if (!is_cut(whole, 9 * cube)) return use(whole);
        for (std::uint64_t i = 0; i < 8; ++i) {
            const Uncut half = eighth(whole, i);
            if (!is_cut(half, 9 * cube + 1 + i)) use(half);
            else
                for (std::uint64_t j = 0; j < 8; ++j) use(eighth(half, j));
        }
    }

    void count_leaves() {
        first_.assign(cubes() + 1, 0);
        core::each_until_cancelled(cubes(), 1 << 8, progress_, [&](std::size_t cube) {
            each_leaf(cube, [&](const Uncut&) { ++first_[cube + 1]; });
        });
        for (std::size_t cube = 0; cube < cubes(); ++cube) first_[cube + 1] += first_[cube];
    }

    std::uint64_t corner_key(const Uncut& leaf, unsigned corner) const {
        return leaf.lowest[0] + (corner & 1) * leaf.edge + row_ * (leaf.lowest[1] + (corner >> 1 & 1) * leaf.edge) +
               row_ * row_ * (leaf.lowest[2] + (corner >> 2) * leaf.edge);
    }

    /// Points along x first, then y, then z.
    void number_points() {
        keys_.resize(8 * first_.back());
        core::each_until_cancelled(cubes(), 1 << 8, progress_, [&](std::size_t cube) {
            std::uint64_t* to = keys_.data() + 8 * first_[cube];
            each_leaf(cube, [&](const Uncut& leaf) {
                for (unsigned corner = 0; corner < 8; ++corner) *to++ = corner_key(leaf, corner);
            });
        });
        core::sort_until_cancelled(progress_, keys_);
        if (progress_.cancelled()) return;
        keys_.erase(std::unique(keys_.begin(), keys_.end()), keys_.end());
    }

    /// Of a corner of the largest cubes.
    std::array<double, 3> corner_place(const Steps& cube) const {
        std::array<double, 3> at{};
        bool inner = true;
        std::uint64_t number = 0;
        for (std::size_t axis = 3; axis-- > 0;) {
            at[axis] = coordinate(finest * cube[axis]);
            inner = inner && cube[axis] > 0 && cube[axis] < side_;
            number = number * (side_ + 1) + cube[axis];
        }
        if (!inner) return at;
        std::uint64_t bits = draw(options_.seed, Stream::position, number);
        for (double& x : at) x += reach_of_corners * 2 / static_cast<double>(side_) * to_symmetric(bits = mix(bits));
        return at;
    }

    /// Trilinear within one of the largest cubes: the same from all that have the point, to the bit.
    Position bent_position(const Steps& at) const {
        Steps cube{};
        std::array<double, 3> part{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            cube[axis] = std::min(at[axis] / finest, side_ - 1);
            part[axis] = static_cast<double>(at[axis] - finest * cube[axis]) / finest;
        }
        std::array<std::array<double, 3>, 8> corners;
        for (std::size_t i = 0; i < 8; ++i)
            corners[i] = corner_place({cube[0] + (i & 1), cube[1] + (i >> 1 & 1), cube[2] + (i >> 2)});
        Position out;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::array<double, 8> x;
            for (std::size_t i = 0; i < 8; ++i) x[i] = corners[i][axis];
            for (std::size_t k = 0, n = 4; k < 3; ++k, n /= 2)
                for (std::size_t i = 0; i < n; ++i) x[i] = (1 - part[k]) * x[2 * i] + part[k] * x[2 * i + 1];
            out[axis] = static_cast<float>(x[0]);
        }
        return out;
    }

    Position position(std::uint64_t point) const {
        const std::uint64_t key = keys_[point];
        const Steps at{key % row_, key / row_ % row_, key / (row_ * row_)};
        if (shape_.bent) return bent_position(at);
        return {static_cast<float>(coordinate(at[0])), static_cast<float>(coordinate(at[1])),
                static_cast<float>(coordinate(at[2]))};
    }

    Array points() const {
        core::Buffer<float> out(3 * keys_.size());
        core::each_until_cancelled(keys_.size(), 1 << 12, progress_, [&](std::size_t point) {
            std::ranges::copy(position(point), out.data() + 3 * point);
        });
        return std::move(out).to_array(3);
    }

    Array connectivity() const {
        core::Buffer<std::int32_t> out(first_.back() * corners_per_leaf());
        const CubeCells& cells = shape_.leaf == Leaf::hexahedron ? hex_cube : kuhn_cube;
        core::each_until_cancelled(cubes(), 1 << 8, progress_, [&](std::size_t cube) {
            std::int32_t* to = out.data() + corners_per_leaf() * first_[cube];
            each_leaf(cube, [&](const Uncut& leaf) {
                for (const std::uint8_t corner : cells.corners) {
                    const auto at = std::ranges::lower_bound(keys_, corner_key(leaf, corner));
                    *to++ = static_cast<std::int32_t>(at - keys_.begin());
                }
            });
        });
        return std::move(out).to_array();
    }

    Array field(std::string_view name) const {
        const auto at = std::ranges::find(analytic_fields, name, &AnalyticField::name)->at;
        if (at) return values<float>([&](std::uint64_t point) { return at(position(point)); });
        return values<std::int32_t>([&](std::uint64_t point) { return small_integer(options_.seed, keys_[point]); });
    }

    template <class Value, class At>
    Array values(const At& at) const {
        core::Buffer<Value> all(keys_.size());
        core::each_until_cancelled(keys_.size(), 1 << 12, progress_,
                                   [&](std::size_t point) { all[point] = at(point); });
        return std::move(all).to_array();
    }

    const OctreeShape& shape_;
    const MakeOptions& options_;
    const Progress& progress_;
    std::uint64_t side_, row_;         ///< points of the finest lattice along an axis
    std::vector<std::uint64_t> first_; ///< leaf of each of the largest cubes
    std::vector<std::uint64_t> keys_;  ///< of points in the finest lattice, ascending
};

} // namespace

Result<Grid> make_octree(const OctreeShape& shape, const MakeOptions& options, const Progress& progress) {
    return Octree(shape, options, progress).make();
}

} // namespace isotet::make
