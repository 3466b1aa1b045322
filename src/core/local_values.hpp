// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Values and positions of a cluster's local points, gathered from the clusters that own them.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/packed.hpp"

namespace isotet::core {

/// Calls f(local index, packed point) for each foreign point of a cluster.
template <class F>
void for_foreign_points(const Packed& packed, const ClusterLinks& links, F&& f) {
    std::size_t local = 0;
    for (const Neighbour& neighbour : links.neighbours) {
        const std::uint64_t first = packed.headers[neighbour.cluster].first_point;
        for (std::size_t end = local + neighbour.foreign_points; local < end; ++local) f(local, first + links.foreign_points[local]);
    }
}

/// Stored values of all local points; returns their number.
template <class Real>
std::size_t load_values(const Packed& packed, std::size_t cluster, Real* out) {
    const ClusterHeader& h = packed.headers[cluster];
    const Real* values = packed.as<Real>().values.data();
    for_foreign_points(packed, packed.cluster_links(cluster), [&](std::size_t local, std::uint64_t point) { out[local] = values[point]; });
    std::copy_n(values + h.first_point, h.own_points, out + h.foreign_points);
    return std::size_t{h.foreign_points} + h.own_points;
}

/// Stored positions of all local points, 3 numbers each.
template <class Real>
void load_positions(const Packed& packed, std::size_t cluster, Real* out) {
    const ClusterHeader& h = packed.headers[cluster];
    const Real* positions = packed.as<Real>().positions.data();
    for_foreign_points(packed, packed.cluster_links(cluster),
                       [&](std::size_t local, std::uint64_t point) { std::copy_n(positions + 3 * point, 3, out + 3 * local); });
    std::copy_n(positions + 3 * h.first_point, 3u * h.own_points, out + 3u * h.foreign_points);
}

} // namespace isotet::core
