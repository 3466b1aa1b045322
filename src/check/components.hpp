// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The connected parts of a surface: triangles that share a vertex belong together.
#pragma once

#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

#include "check/mesh.hpp"
#include "core/parallel.hpp"

namespace isotet::checking {

/// Numbers the components by their lowest vertex.
///
/// Method   union-find without locks, always linking the higher root to the lower (Anderson and Woll 1991): whatever the
///          threads do, the root of a component is its lowest vertex
template <class Index>
class Components {
public:
    explicit Components(const Mesh& mesh) : labels_(mesh.vertices()) {
        constexpr std::size_t grain = 1 << 14;
        std::vector<std::uint8_t> used(mesh.vertices());
        core::parallel_each(mesh.vertices(), grain, [&](std::size_t v) { labels_[v] = static_cast<Index>(v); });
        core::parallel_each(mesh.triangles(), grain, [&](std::size_t triangle) {
            const Corners corners = mesh.corners(triangle);
            if (has_equal_corners(corners)) return;
            for (const std::uint64_t v : corners) std::atomic_ref(used[v]).store(1, std::memory_order_relaxed);
            unite(static_cast<Index>(corners[0]), static_cast<Index>(corners[1]));
            unite(static_cast<Index>(corners[0]), static_cast<Index>(corners[2]));
        });
        core::parallel_each(mesh.vertices(), grain, [&](std::size_t v) {
            const Index top = root(static_cast<Index>(v));
            std::atomic_ref(labels_[v]).store(top, std::memory_order_relaxed);
        });
        // A root comes before all others of its component, so it has its number when they ask for it.
        for (std::uint64_t v = 0; v < labels_.size(); ++v) {
            if (labels_[v] != v) labels_[v] = labels_[labels_[v]];
            else labels_[v] = used[v] ? static_cast<Index>(count_++) : Index{0};
        }
    }

    std::uint64_t count() const noexcept { return count_; }
    std::uint64_t of(std::uint64_t vertex) const { return labels_[vertex]; } ///< meaningless for unused vertices

private:
    Index root(Index v) {
        for (;;) {
            const std::atomic_ref<Index> parent(labels_[v]);
            const Index up = parent.load(std::memory_order_relaxed);
            if (up == v) return v;
            const Index upper = std::atomic_ref(labels_[up]).load(std::memory_order_relaxed);
            if (upper != up) parent.store(upper, std::memory_order_relaxed);
            v = up;
        }
    }
    void unite(Index a, Index b) {
        for (;;) {
            a = root(a);
            b = root(b);
            if (a == b) return;
            if (a < b) std::swap(a, b);
            Index expected = a;
            if (std::atomic_ref(labels_[a]).compare_exchange_strong(expected, b, std::memory_order_relaxed)) return;
        }
    }

    std::vector<Index> labels_; ///< first parents, then component numbers
    std::uint64_t count_ = 0;
};

} // namespace isotet::checking
