// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Values and positions of a cluster's local points, gathered from the clusters that own them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "packed/packed.hpp"

namespace isotet::core {

/// Packed points of the local points of a cluster.
class LocalPoints {
public:
    void find(const Packed& packed, std::size_t cluster) {
        const ClusterHeader& h = packed.headers[cluster];
        wide_ = h.first_point + h.own_points > narrow_end; // ghost points have lower numbers
        if (wide_) list(packed, cluster, wide_points_.data());
        else list(packed, cluster, points_.data());
    }
    std::size_t ghost() const { return ghost_; } ///< how many; they come first
    std::uint64_t operator[](std::size_t local) const { return wide_ ? wide_points_[local] : points_[local]; }

private:
    static constexpr std::uint64_t narrow_end = std::uint64_t{1} << 32;
    static constexpr std::size_t at_once = 32;
    static_assert(at_once <= 4 * slack_words);

    template <class Point>
    void list(const Packed& packed, std::size_t cluster, Point* out) {
        const ClusterHeader& h = packed.headers[cluster];
        const ClusterLinks links = packed.cluster_links(cluster);
        // Many at once, without a branch a point: what is read and written too much is written again, or left alone.
        const std::uint8_t* const indices = links.ghost_points.data();
        std::size_t n = 0;
        for (const Neighbour& neighbour : links.neighbours) {
            const auto first = static_cast<Point>(packed.headers[neighbour.cluster].first_point);
            for (std::size_t k = 0; k < neighbour.ghost_points; k += at_once)
                for (std::size_t i = 0; i < at_once; ++i) out[n + k + i] = first + indices[n + k + i];
            n += neighbour.ghost_points;
        }
        ghost_ = n;
        const auto first = static_cast<Point>(h.first_point);
        for (std::size_t k = 0; k < h.own_points; k += at_once)
            for (std::size_t i = 0; i < at_once; ++i) out[n + k + i] = first + static_cast<Point>(k + i);
    }

    std::array<std::uint32_t, max_cluster_points + at_once> points_;
    std::array<std::uint64_t, max_cluster_points + at_once> wide_points_;
    std::size_t ghost_ = 0;
    bool wide_ = false;
};

/// Stored values of all local points; returns their number.
template <class Real>
std::size_t load_values(const Packed& packed, std::size_t cluster, const LocalPoints& points, Real* out) {
    const ClusterHeader& h = packed.headers[cluster];
    const Real* values = packed.as<Real>().values.data();
    for (std::size_t k = 0; k < points.ghost(); ++k) out[k] = values[points[k]];
    std::copy_n(values + h.first_point, h.own_points, out + points.ghost());
    return points.ghost() + h.own_points;
}

template <class Real>
std::size_t load_values(const Packed& packed, std::size_t cluster, Real* out) {
    LocalPoints points;
    points.find(packed, cluster);
    return load_values(packed, cluster, points, out);
}

/// Stored positions of all local points, 3 numbers each.
template <class Real>
void load_positions(const Packed& packed, std::size_t cluster, Real* out) {
    const ClusterHeader& h = packed.headers[cluster];
    const Real* positions = packed.as<Real>().positions.data();
    LocalPoints points;
    points.find(packed, cluster);
    for (std::size_t k = 0; k < points.ghost(); ++k) std::copy_n(positions + 3 * points[k], 3, out + 3 * k);
    std::copy_n(positions + 3 * h.first_point, 3u * h.own_points, out + 3u * h.ghost_points);
}

} // namespace isotet::core
