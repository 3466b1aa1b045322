// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which triangles use a vertex: the index that everything around vertices and edges is found with.
#pragma once

#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "check/mesh.hpp"
#include "core/parallel.hpp"

namespace isotet::checking {

/// The triangles around every vertex, those with equal corners left out.
///
/// `Index`   an integer that can hold all numbers of vertices and triangles
/// Cost      8 bytes a vertex and 3 Index a triangle
template <class Index>
class Stars {
public:
    explicit Stars(const Mesh& mesh) : ends_(mesh.vertices() + 1) {
        constexpr std::size_t grain = 1 << 14;
        const auto for_corners = [&](const auto& body) {
            core::parallel_each(mesh.triangles(), grain, [&](std::size_t triangle) {
                const Corners corners = mesh.corners(triangle);
                if (has_equal_corners(corners)) return;
                for (const std::uint64_t vertex : corners) body(triangle, std::atomic_ref(ends_[vertex]));
            });
        };
        for_corners([](std::size_t, auto count) { count.fetch_add(1, std::memory_order_relaxed); });
        std::uint64_t sum = 0;
        for (std::uint64_t& end : ends_) end = sum += end;
        triangles_ = std::make_unique_for_overwrite<Index[]>(sum);
        // Filling each list from its end leaves in ends_[v] where it begins, which is where that of v - 1 ends.
        for_corners([&](std::size_t triangle, auto end) {
            triangles_[end.fetch_sub(1, std::memory_order_relaxed) - 1] = static_cast<Index>(triangle);
        });
    }

    /// In an order that depends on the threads: sort it.
    std::span<Index> of(std::uint64_t vertex) {
        return {triangles_.get() + ends_[vertex], triangles_.get() + ends_[vertex + 1]};
    }

private:
    std::vector<std::uint64_t> ends_;
    std::unique_ptr<Index[]> triangles_;
};

} // namespace isotet::checking
