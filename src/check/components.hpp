// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The connected parts of a surface: triangles that share a vertex belong together.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "base/disjoint_sets.hpp"
#include "base/until_cancelled.hpp"
#include "check/mesh.hpp"

namespace isotet::checking {

/// Of triangles with a corner twice.
enum class Collapsed : std::uint8_t {
    no_part,   ///< they are passed over
    some_part, ///< each is in the part of its first corner, and joins none
};

/// Numbers the components by their lowest vertex. Unused vertices are in none. Of no use after a cancel.
template <class Index>
class Components {
public:
    explicit Components(const Mesh& mesh, Collapsed collapsed = Collapsed::no_part, const Progress& progress = {})
        : numbers_(mesh.vertex_count()) {
        constexpr std::size_t grain = 1 << 14;
        core::DisjointSets<Index> sets(mesh.vertex_count());
        std::vector<std::uint8_t> used(mesh.vertex_count());
        core::each_until_cancelled(mesh.triangles(), grain, progress, [&](std::size_t triangle) {
            const Corners corners = mesh.corners(triangle);
            const auto use = [&](std::uint64_t v) { std::atomic_ref(used[v]).store(1, std::memory_order_relaxed); };
            if (has_equal_corners(corners)) {
                if (collapsed == Collapsed::some_part) use(corners[0]);
                return;
            }
            for (const std::uint64_t v : corners) use(v);
            sets.unite(static_cast<Index>(corners[0]), static_cast<Index>(corners[1]));
            sets.unite(static_cast<Index>(corners[0]), static_cast<Index>(corners[2]));
        });
        core::each_until_cancelled(mesh.vertex_count(), grain, progress,
                                   [&](std::size_t v) { numbers_[v] = sets.root(static_cast<Index>(v)); });
        // A root comes before all others of its component, so it has its number when they ask for it.
        for (std::uint64_t v = 0; v < numbers_.size(); ++v) {
            if (v % grain == 0 && progress.cancelled()) return;
            if (numbers_[v] != v) numbers_[v] = numbers_[numbers_[v]];
            else if (used[v]) numbers_[v] = static_cast<Index>(count_++);
        }
    }

    std::uint64_t count() const noexcept { return count_; }
    std::uint64_t of(std::uint64_t vertex) const { return numbers_[vertex]; } ///< of a vertex that a triangle uses

private:
    std::vector<Index> numbers_; ///< first roots, then numbers of components
    std::uint64_t count_ = 0;
};

} // namespace isotet::checking
