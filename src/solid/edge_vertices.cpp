// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/edge_vertices.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "base/parallel.hpp"

namespace isotet::solid {

namespace {

constexpr std::size_t vertices_at_once = 1 << 14, lows_at_once = 1 << 15;

struct EndsOfVertex {
    std::uint64_t low, high;

    friend auto operator<=>(const EndsOfVertex&, const EndsOfVertex&) = default;
};

EndsOfVertex ends_of(std::span<const std::int64_t> ends, std::size_t vertex) {
    const auto a = static_cast<std::uint64_t>(ends[2 * vertex]), b = static_cast<std::uint64_t>(ends[2 * vertex + 1]);
    return {std::min(a, b), std::max(a, b)};
}

/// Whether each vertex comes behind the one before it.
bool are_sorted(std::span<const std::int64_t> ends, std::size_t vertices) {
    std::atomic<bool> sorted{true};
    core::parallel_ranges(vertices, vertices_at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = std::max<std::size_t>(begin, 1); i < end; ++i)
            if (!(ends_of(ends, i - 1) < ends_of(ends, i))) return sorted.store(false, std::memory_order_relaxed);
    });
    return sorted;
}

/// How many vertices have each point as their lower end.
core::Buffer<std::uint32_t> count_by_low(std::span<const std::int64_t> ends, std::size_t vertices,
                                         std::uint64_t points) {
    core::Buffer<std::uint32_t> counts(points + 1);
    core::parallel_ranges(counts.size(), lows_at_once, [&](std::size_t begin, std::size_t end) {
        std::fill(counts.begin() + begin, counts.begin() + end, 0u);
    });
    core::parallel_each(vertices, vertices_at_once, [&](std::size_t i) {
        std::atomic_ref(counts[ends_of(ends, i).low]).fetch_add(1, std::memory_order_relaxed);
    });
    return counts;
}

/// Of counts the sums up to each, with it.
void add_up(core::Buffer<std::uint32_t>& counts) {
    const std::size_t ranges = (counts.size() + lows_at_once - 1) / lows_at_once;
    const auto end_of = [&](std::size_t range) { return std::min(counts.size(), (range + 1) * lows_at_once); };
    std::vector<std::uint32_t> before(ranges + 1);
    core::parallel_each(ranges, 1, [&](std::size_t range) {
        const std::uint32_t* const data = counts.data();
        before[range + 1] = std::accumulate(data + range * lows_at_once, data + end_of(range), 0u);
    });
    std::partial_sum(before.begin(), before.end(), before.begin());
    core::parallel_each(ranges, 1, [&](std::size_t range) {
        std::uint32_t sum = before[range];
        for (std::size_t i = range * lows_at_once; i < end_of(range); ++i) counts[i] = sum += counts[i];
    });
}

/// The higher end, then the number in the surface: what sorts vertices of one lower end.
std::uint64_t sort_key(std::uint64_t high, std::size_t vertex) { return high << 32 | vertex; }

} // namespace

EdgeVertices::EdgeVertices(const Surface& surface, std::uint64_t points) {
    const std::size_t vertices = surface.vertex_count();
    if (vertices == 0) return;
    const auto ends = surface.edge_ends.as<std::int64_t>();
    // Sums count down to where each point's vertices begin, while these take their places.
    first_ = count_by_low(ends, vertices, points);
    add_up(first_);
    core::Buffer<std::uint64_t> keys(vertices);
    core::parallel_each(vertices, vertices_at_once, [&](std::size_t i) {
        const auto [low, high] = ends_of(ends, i);
        keys[std::atomic_ref(first_[low]).fetch_sub(1, std::memory_order_relaxed) - 1] = sort_key(high, i);
    });
    high_ = core::Buffer<std::uint32_t>(vertices);
    if (!are_sorted(ends, vertices)) order_ = core::Buffer<std::uint32_t>(vertices);
    std::mutex mutex;
    core::parallel_ranges(points, lows_at_once, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint32_t> tied;
        for (std::size_t point = begin; point < end; ++point) {
            const std::uint32_t first = first_[point], last = first_[point + 1];
            if (first == last) continue;
            std::sort(keys.begin() + first, keys.begin() + last);
            for (std::uint32_t i = first; i < last; ++i) {
                high_[i] = static_cast<std::uint32_t>(keys[i] >> 32);
                if (!order_.empty()) order_[i] = static_cast<std::uint32_t>(keys[i]);
                if (high_[i] == point) tied.push_back(i);
            }
        }
        if (tied.empty()) return;
        const std::lock_guard lock(mutex);
        tied_.insert(tied_.end(), tied.begin(), tied.end());
    });
    std::ranges::sort(tied_);
}

} // namespace isotet::solid
