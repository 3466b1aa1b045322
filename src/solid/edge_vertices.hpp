// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The vertices of an isosurface, found by the ends of their edges.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <isotet/surface.hpp>

#include "base/buffer.hpp"

namespace isotet::solid {

/// Vertices are numbered by the lower, then the higher end of their edge: in the same order for every method.
class EdgeVertices {
public:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    EdgeVertices() = default;
    /// `surface`   with edge ends
    /// `points`    of the grid; fewer than 2^32
    /// Cost        O(points + vertices)
    EdgeVertices(const Surface& surface, std::uint64_t points);

    std::uint32_t count() const { return static_cast<std::uint32_t>(high_.size()); }

    /// The vertex on the edge between two points; of a tied point: both are that point.
    std::uint32_t find(std::uint64_t a, std::uint64_t b) const {
        if (high_.empty()) return none;
        const std::uint64_t low = a < b ? a : b, high = a < b ? b : a;
        for (std::uint32_t i = first_[low]; i < first_[low + 1]; ++i)
            if (high_[i] == high) return i;
        return none;
    }
    /// The one of the surface.
    std::uint32_t in_surface(std::uint32_t vertex) const { return order_.empty() ? vertex : order_[vertex]; }
    std::uint32_t high(std::uint32_t vertex) const { return high_[vertex]; }
    /// Those at tied points, ascending.
    const std::vector<std::uint32_t>& tied() const { return tied_; }

private:
    core::Buffer<std::uint32_t> first_; ///< of each point as the lower end, and behind the last
    core::Buffer<std::uint32_t> high_;
    core::Buffer<std::uint32_t> order_; ///< empty: they are in the surface's order
    std::vector<std::uint32_t> tied_; ///< ascending
};

} // namespace isotet::solid
