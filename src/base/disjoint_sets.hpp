// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sets that are joined by many threads at once.
#pragma once

#include <atomic>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace isotet::core {

/// The numbers 0 .. n - 1, at first each a set of its own. Whatever the threads do, the root of a set is its lowest
/// number.
///
/// `Index`   an integer that can hold n
/// Method    union-find without locks, the higher root linked to the lower (Anderson and Woll 1991), path halving
template <class Index>
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parents_(count) {
        std::iota(parents_.begin(), parents_.end(), Index{0});
    }

    std::size_t size() const noexcept { return parents_.size(); }

    Index root(Index i) {
        for (;;) {
            const std::atomic_ref<Index> parent(parents_[i]);
            const Index up = parent.load(std::memory_order_relaxed);
            if (up == i) return i;
            const Index upper = std::atomic_ref(parents_[up]).load(std::memory_order_relaxed);
            if (upper != up) parent.store(upper, std::memory_order_relaxed);
            i = up;
        }
    }

    void unite(Index a, Index b) {
        for (;;) {
            a = root(a);
            b = root(b);
            if (a == b) return;
            if (a < b) std::swap(a, b);
            Index expected = a;
            if (std::atomic_ref(parents_[a]).compare_exchange_strong(expected, b, std::memory_order_relaxed)) return;
        }
    }

private:
    std::vector<Index> parents_;
};

} // namespace isotet::core
