// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// For each key (a point, a vertex) the list of items (cells, triangles) that use it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <isotet/progress.hpp>

#include "base/buffer.hpp"
#include "base/parallel.hpp"

namespace isotet::core {

/// `Index`   an integer that can hold all numbers of items
/// Cost      8 bytes a key and one Index a use; built in parallel, in two passes
template <class Index>
class Incidence {
public:
    /// `keys_of(item, body)` calls body(key) for every key of an item, the same ones each time. Cancelled, no list is sound.
    template <class KeysOf>
    Incidence(std::size_t keys, std::size_t items, const KeysOf& keys_of, const Progress& progress = {})
        : begins_(keys + 1) {
        constexpr std::size_t grain = 1 << 14;
        const auto for_uses = [&](const auto& body) {
            parallel_pieces(items, grain, progress, [&](std::size_t begin, std::size_t end) {
                for (std::size_t item = begin; item < end; ++item)
                    keys_of(item, [&](std::uint64_t key) { body(item, std::atomic_ref(begins_[key])); });
            });
        };
        for_uses([](std::size_t, auto count) { count.fetch_add(1, std::memory_order_relaxed); });
        if (progress.cancelled()) { // not all were counted
            std::ranges::fill(begins_, 0);
            return;
        }
        std::uint64_t sum = 0;
        for (std::uint64_t& end : begins_) end = sum += end;
        items_ = Buffer<Index>(sum);
        // Each list is filled from its end, so that what was its end becomes its beginning.
        for_uses([&](std::size_t item, auto end) {
            items_[end.fetch_sub(1, std::memory_order_relaxed) - 1] = static_cast<Index>(item);
        });
    }

    /// In an order that depends on the threads: sort it before use.
    std::span<Index> of(std::uint64_t key) { return {items_.data() + begins_[key], items_.data() + begins_[key + 1]}; }

private:
    std::vector<std::uint64_t> begins_;
    Buffer<Index> items_;
};

} // namespace isotet::core
