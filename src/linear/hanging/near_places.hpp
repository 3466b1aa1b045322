// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "grid/orientation.hpp"
#include "linear/hanging/place_tree.hpp"

namespace isotet::linear {

/// What holds some points.
struct Box {
    void add(const core::Point& at) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], at[axis]);
            upper[axis] = std::max(upper[axis], at[axis]);
        }
    }
    /// By a share of its diagonal, on each side.
    Box wider(double share) const {
        const double more = share * std::sqrt(core::squared_distance(lower, upper));
        Box out = *this;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            out.lower[axis] -= more;
            out.upper[axis] += more;
        }
        return out;
    }
    bool holds(const Box& other) const {
        bool all = true;
        for (std::size_t axis = 0; axis < 3; ++axis)
            all &= lower[axis] <= other.lower[axis] && other.upper[axis] <= upper[axis];
        return all;
    }

    static constexpr double most = std::numeric_limits<double>::max();
    core::Point lower{most, most, most}, upper{-most, -most, -most};
};

/// Places by tiles that have some, 128 along each axis, and by a tree.
class NearPlaces {
public:
    explicit NearPlaces(const std::vector<core::Point>& places) : tree_(places), rows_(side * side) {
        for (const core::Point& place : places) around_.add(place);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double extent = around_.upper[axis] - around_.lower[axis];
            tiles_[axis] = extent > 0 ? static_cast<double>(side) / extent : 0;
        }
        for (const core::Point& place : places) {
            const std::size_t x = tile(0, place);
            rows_[row(tile(1, place), tile(2, place))][x / 64] |= std::uint64_t{1} << (x % 64);
        }
    }

    /// False: none is in the box. True where its tiles have some.
    bool may_have_some_in(const Box& box) const {
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (!(box.lower[axis] <= around_.upper[axis] && box.upper[axis] >= around_.lower[axis])) return false;
        const auto first = [&](std::size_t axis) { return tile(axis, box.lower); };
        const auto last = [&](std::size_t axis) { return tile(axis, box.upper); };
        const std::array<std::uint64_t, 2> along = bits(first(0), last(0));
        for (std::size_t z = first(2), top = last(2); z <= top; ++z)
            for (std::size_t y = first(1), back = last(1); y <= back; ++y) {
                const Row& has = rows_[row(y, z)];
                if ((has[0] & along[0]) != 0 || (has[1] & along[1]) != 0) return true;
            }
        return false;
    }

    /// Calls use(i) for each place i in a box.
    template <class Use>
    void each_in(const Box& box, const Use& use) const {
        tree_.each_in(box.lower, box.upper, use);
    }

private:
    static constexpr std::size_t side = 128;
    using Row = std::array<std::uint64_t, side / 64>;

    static std::size_t row(std::size_t y, std::size_t z) { return z * side + y; }
    static Row bits(std::size_t first, std::size_t last) {
        const auto up_to = [](std::size_t count) { // the lowest of a word
            return count >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << count) - 1;
        };
        const auto of_word = [&](std::size_t begin) {
            const std::size_t low = std::max(first, begin) - begin, high = std::max(last + 1, begin) - begin;
            return low >= 64 ? 0 : up_to(high) & ~up_to(low);
        };
        return {of_word(0), of_word(64)};
    }
    std::size_t tile(std::size_t axis, const core::Point& at) const {
        const double place = (at[axis] - around_.lower[axis]) * tiles_[axis];
        return place > 0 ? static_cast<std::size_t>(std::min(place, static_cast<double>(side - 1))) : 0;
    }

    PlaceTree tree_;
    Box around_;
    std::array<double, 3> tiles_{}; ///< in a unit of length
    std::vector<Row> rows_;         ///< a bit for each tile
};

} // namespace isotet::linear
