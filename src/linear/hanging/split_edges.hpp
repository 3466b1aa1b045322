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
    ///
    /// Cost   sorting of these; a pass over all, and over the points that are ends
    void add(const std::vector<PointOnEdge>& more);

    std::size_t size() const { return all_.size(); }
    /// By edge, then along it.
    PointOnEdge operator[](std::size_t i) const { return all_[i].at; }

    /// Whether there is a point between two ends.
    bool is_split(std::uint64_t from, std::uint64_t to) const {
        return may_be_split(from, to) && !known(from, to).empty();
    }

    /// Appends the points between two ends, in their order from the first to the second, with those between these, and
    /// so on.
    void append_between(std::uint64_t from, std::uint64_t to, std::vector<std::uint64_t>& out) const {
        if (may_be_split(from, to)) append_known(from, to, out);
    }
    /// A loop with all points between its own.
    void expand(std::span<const std::uint64_t> loop, std::vector<std::uint64_t>& out) const {
        for (std::size_t i = 0; i < loop.size(); ++i) {
            out.push_back(loop[i]);
            append_between(loop[i], loop[i + 1 < loop.size() ? i + 1 : 0], out);
        }
    }

private:
    struct Placed {
        PointOnEdge at;
        double part; ///< of the way from the lower end to the other
    };

    bool may_be_split(std::uint64_t from, std::uint64_t to) const {
        const std::uint64_t low = from < to ? from : to;
        return low + 1 < first_.size() && first_[low] != first_[low + 1];
    }
    /// What is known of an edge that may be split.
    std::span<const Placed> known(std::uint64_t from, std::uint64_t to) const;
    bool is_between(const PointOnEdge& at) const;
    double part_of(const PointOnEdge& at) const;
    void note_first();
    void append_known(std::uint64_t from, std::uint64_t to, std::vector<std::uint64_t>& out) const;

    const core::PointReader& points_;
    std::vector<Placed> all_;
    std::vector<std::size_t> first_; ///< by lower end: the first of its points, and one more
};

} // namespace isotet::linear
