// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Edges with points between their ends.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "grid/orientation.hpp"

namespace isotet::linear {

/// A point between the ends of an edge.
struct PointOnEdge {
    std::uint64_t low, high, point;
};

class SplitEdges {
public:
    /// `points`   of the grid; borrowed
    explicit SplitEdges(const core::PointReader& points) : points_(points) {}

    /// Adds points; those that are there stay once. Along each edge they are sorted by their places on the line between
    /// its ends.
    void add(std::vector<PointOnEdge> more);

    bool empty() const { return all_.empty(); }
    const std::vector<PointOnEdge>& all() const { return all_; }

    /// Appends the points between two ends, in their order from the first to the second, with those between these, and
    /// so on.
    void append_between(std::uint64_t from, std::uint64_t to, std::vector<std::uint64_t>& out) const;
    /// A loop with all points between its own.
    void expand(std::span<const std::uint64_t> loop, std::vector<std::uint64_t>& out) const;

private:
    bool is_between(const PointOnEdge& at) const;
    double part_of(const PointOnEdge& at) const;

    const core::PointReader& points_;
    std::vector<PointOnEdge> all_;     ///< by edge, then along it
    std::vector<std::uint8_t> is_low_; ///< by point: whether it is the lower end of some edge
};

} // namespace isotet::linear
