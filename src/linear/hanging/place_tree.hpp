// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Places in boxes within boxes.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include <tbb/parallel_invoke.h>

#include "grid/orientation.hpp"

namespace isotet::linear {

/// A k-d tree (Bentley 1975): the middle one of a range splits it.
class PlaceTree {
public:
    explicit PlaceTree(std::vector<core::Point> places)
        : places_(std::move(places)), order_(places_.size()), axes_(places_.size()) {
        std::iota(order_.begin(), order_.end(), 0U);
        build(0, order_.size());
    }

    /// Calls use(i) for each place i in a box, its ends included, in no particular order.
    template <class Use>
    void each_in(const core::Point& lower, const core::Point& upper, const Use& use) const {
        look(0, order_.size(), lower, upper, use);
    }

private:
    static constexpr std::size_t few = 8, many = 1 << 14;

    void build(std::size_t begin, std::size_t end) {
        if (end - begin <= few) return;
        core::Point lower = places_[order_[begin]], upper = lower;
        for (std::size_t i = begin; i < end; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                lower[axis] = std::min(lower[axis], places_[order_[i]][axis]);
                upper[axis] = std::max(upper[axis], places_[order_[i]][axis]);
            }
        std::size_t widest = 0;
        for (std::size_t axis = 1; axis < 3; ++axis)
            if (upper[axis] - lower[axis] > upper[widest] - lower[widest]) widest = axis;
        const std::size_t middle = begin + (end - begin) / 2;
        const auto at = [&](std::size_t i) { return order_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
            return std::pair(places_[a][widest], a) < std::pair(places_[b][widest], b);
        });
        axes_[middle] = static_cast<std::uint8_t>(widest);
        const auto first = [&] { build(begin, middle); };
        const auto second = [&] { build(middle + 1, end); };
        if (end - begin > many) return tbb::parallel_invoke(first, second);
        first();
        second();
    }

    template <class Use>
    void look(std::size_t begin, std::size_t end, const core::Point& lower, const core::Point& upper,
              const Use& use) const {
        const auto look_at = [&](std::uint32_t i) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (!(places_[i][axis] >= lower[axis] && places_[i][axis] <= upper[axis])) return;
            use(i);
        };
        if (end - begin <= few) {
            for (std::size_t i = begin; i < end; ++i) look_at(order_[i]);
            return;
        }
        const std::size_t middle = begin + (end - begin) / 2;
        const std::size_t axis = axes_[middle];
        const double split = places_[order_[middle]][axis];
        look_at(order_[middle]);
        if (lower[axis] <= split) look(begin, middle, lower, upper, use);
        if (upper[axis] >= split) look(middle + 1, end, lower, upper, use);
    }

    std::vector<core::Point> places_;
    std::vector<std::uint32_t> order_;
    std::vector<std::uint8_t> axes_; ///< of the middle of a range
};

} // namespace isotet::linear
