// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/edge_vertices.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <tbb/parallel_sort.h>

#include "base/parallel.hpp"

namespace isotet::solid {

namespace {

constexpr std::size_t vertices_at_once = 1 << 14;

struct EndsOfVertex {
    std::uint64_t low, high;

    friend auto operator<=>(const EndsOfVertex&, const EndsOfVertex&) = default;
};

EndsOfVertex ends_of(std::span<const std::int64_t> ends, std::size_t vertex) {
    const auto a = static_cast<std::uint64_t>(ends[2 * vertex]), b = static_cast<std::uint64_t>(ends[2 * vertex + 1]);
    return {std::min(a, b), std::max(a, b)};
}

/// Empty where they are sorted already.
core::Buffer<std::uint32_t> sorted_order(std::span<const std::int64_t> ends, std::size_t vertices) {
    std::atomic<bool> sorted{true};
    core::parallel_ranges(vertices, vertices_at_once, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = std::max<std::size_t>(begin, 1); i < end; ++i)
            if (!(ends_of(ends, i - 1) < ends_of(ends, i))) return sorted.store(false, std::memory_order_relaxed);
    });
    if (sorted) return {};
    core::Buffer<std::uint32_t> order(vertices);
    std::iota(order.begin(), order.end(), std::uint32_t{0});
    tbb::parallel_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        const EndsOfVertex of_a = ends_of(ends, a), of_b = ends_of(ends, b);
        return of_a == of_b ? a < b : of_a < of_b;
    });
    return order;
}

} // namespace

EdgeVertices::EdgeVertices(const Surface& surface, std::uint64_t points) {
    const std::size_t vertices = surface.vertex_count();
    if (vertices == 0) return;
    const auto ends = surface.edge_ends.as<std::int64_t>();
    order_ = sorted_order(ends, vertices);
    high_ = core::Buffer<std::uint32_t>(vertices);
    first_ = core::Buffer<std::uint32_t>(points + 1);
    const auto low_of = [&](std::size_t i) {
        return ends_of(ends, in_surface(static_cast<std::uint32_t>(i))).low;
    };
    std::vector<std::uint32_t> tied;
    std::mutex mutex;
    core::parallel_ranges(vertices, vertices_at_once, [&](std::size_t begin, std::size_t end) {
        std::uint64_t next = begin == 0 ? 0 : low_of(begin - 1) + 1;
        for (std::size_t i = begin; i < end; ++i) {
            const EndsOfVertex of_vertex = ends_of(ends, in_surface(static_cast<std::uint32_t>(i)));
            high_[i] = static_cast<std::uint32_t>(of_vertex.high);
            for (; next <= of_vertex.low; ++next) first_[next] = static_cast<std::uint32_t>(i);
            if (of_vertex.low != of_vertex.high) continue;
            const std::lock_guard lock(mutex);
            tied.push_back(static_cast<std::uint32_t>(i));
        }
        if (end == vertices)
            for (; next <= points; ++next) first_[next] = static_cast<std::uint32_t>(end);
    });
    std::ranges::sort(tied);
    tied_ = std::move(tied);
}

} // namespace isotet::solid
