// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "grid/orientation.hpp"
#include "linear/hanging/face_shapes.hpp"
#include "linear/hanging/place_tree.hpp"

namespace isotet::linear {

/// What holds some points.
struct Box {
    void add(const Point& at) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], at[axis]);
            upper[axis] = std::max(upper[axis], at[axis]);
        }
    }
    /// By what curved neighbours may be beside them.
    void widen() {
        const double more = beside_face * std::sqrt(core::squared_distance(lower, upper));
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] -= more;
            upper[axis] += more;
        }
    }

    static constexpr double most = std::numeric_limits<double>::max();
    Point lower{most, most, most}, upper{-most, -most, -most};
};

/// Whether boxes have some of many places: by counts of these in equal tiles, then by a tree.
class NearPlaces {
public:
    explicit NearPlaces(const std::vector<Point>& places) : tree_(places) {
        for (const Point& place : places) around_.add(place);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double extent = around_.upper[axis] - around_.lower[axis];
            tiles_[axis] = extent > 0 ? static_cast<double>(side) / extent : 0;
        }
        sums_.assign((side + 1) * (side + 1) * (side + 1), 0);
        for (const Point& place : places) ++sum(tile(0, place) + 1, tile(1, place) + 1, tile(2, place) + 1);
        for (std::size_t x = 1; x <= side; ++x)
            for (std::size_t y = 1; y <= side; ++y)
                for (std::size_t z = 1; z <= side; ++z)
                    sum(x, y, z) += sum(x - 1, y, z) + sum(x, y - 1, z) - sum(x - 1, y - 1, z) + sum(x, y, z - 1) -
                                    sum(x - 1, y, z - 1) - sum(x, y - 1, z - 1) + sum(x - 1, y - 1, z - 1);
    }

    bool has_some_in(const Box& box) const {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (!(box.lower[axis] <= around_.upper[axis] && box.upper[axis] >= around_.lower[axis])) return false;
        std::array<std::size_t, 3> first{}, last{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            first[axis] = tile(axis, box.lower);
            last[axis] = tile(axis, box.upper) + 1;
        }
        const auto up_to = [&](std::size_t z) {
            return sum(last[0], last[1], z) - sum(first[0], last[1], z) - sum(last[0], first[1], z) +
                   sum(first[0], first[1], z);
        };
        if (up_to(last[2]) == up_to(first[2])) return false;
        bool found = false;
        tree_.each_in(box.lower, box.upper, [&](std::uint32_t) { found = true; });
        return found;
    }

private:
    static constexpr std::size_t side = 48;

    std::size_t tile(std::size_t axis, const Point& at) const {
        const double place = (at[axis] - around_.lower[axis]) * tiles_[axis];
        return place > 0 ? std::min(side - 1, static_cast<std::size_t>(std::min(place, 1.0 * side))) : 0;
    }
    std::uint32_t& sum(std::size_t x, std::size_t y, std::size_t z) {
        return sums_[(x * (side + 1) + y) * (side + 1) + z];
    }
    std::uint32_t sum(std::size_t x, std::size_t y, std::size_t z) const {
        return sums_[(x * (side + 1) + y) * (side + 1) + z];
    }

    PlaceTree tree_;
    Box around_;
    std::array<double, 3> tiles_{};   ///< in a unit of length
    std::vector<std::uint32_t> sums_; ///< of places in tiles before
};

} // namespace isotet::linear
