// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/rim.hpp"

#include <algorithm>
#include <mutex>
#include <span>
#include <tuple>

#include <tbb/parallel_sort.h>

#include "base/parallel.hpp"

namespace isotet::solid {

BoundaryPoints::BoundaryPoints(const BoundaryFaces& boundary, std::uint64_t grid_points)
    : bits_((grid_points + 63) / 64) {
    for (const std::uint64_t point : boundary.points) bits_[point / 64] |= std::uint64_t{1} << point % 64;
}

Rim::Rim(const Surface& surface, const BoundaryPoints& points) {
    if (surface.vertex_count() == 0) return;
    const std::span<const std::int64_t> ends = surface.edge_ends.as<std::int64_t>();
    std::mutex mutex;
    core::parallel_ranges(surface.vertex_count(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        std::vector<Entry> here;
        for (std::size_t vertex = begin; vertex < end; ++vertex) {
            const auto below = static_cast<std::uint64_t>(ends[2 * vertex]);
            const auto above = static_cast<std::uint64_t>(ends[2 * vertex + 1]);
            if (points.has(below) && points.has(above))
                here.push_back({below, above, static_cast<std::uint32_t>(vertex)});
        }
        const std::lock_guard lock(mutex);
        entries_.insert(entries_.end(), here.begin(), here.end());
    });
    tbb::parallel_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
        return std::tie(a.below, a.above, a.vertex) < std::tie(b.below, b.above, b.vertex);
    });
}

std::uint32_t Rim::find(std::uint64_t below, std::uint64_t above) const {
    const auto ends = std::tie(below, above);
    const auto at = std::ranges::partition_point(
        entries_, [&](const Entry& entry) { return std::tie(entry.below, entry.above) < ends; });
    return at != entries_.end() && at->below == below && at->above == above ? at->vertex : no_vertex;
}

} // namespace isotet::solid
