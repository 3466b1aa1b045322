// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Loops and sorts that stop midway.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/progress.hpp>

#include "base/parallel.hpp"

namespace isotet::core {

/// parallel_each() in pieces of at most `grain`; after a cancel for no further ones.
template <class Body>
void each_until_cancelled(std::size_t count, std::size_t grain, const Progress& progress, const Body& body) {
    parallel_pieces(count, grain, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) body(i);
    });
}

/// Calls sort(comparison), which sorts by it. After a cancel the comparison throws what is caught here, and the items
/// are in any order.
template <class Before, class Sort>
void sort_until_cancelled(const Progress& progress, const Before& before, const Sort& sort) {
#ifdef __wasm__ // throwing there ends all
    sort(before);
#else
    struct Stopped {};
    try {
        sort([&progress, &before](const auto& a, const auto& b) {
            if (progress.cancelled()) throw Stopped();
            return before(a, b);
        });
    } catch (const Stopped&) {}
#endif
}

/// Sorts numbers, in parallel.
ISOTET_API void sort_until_cancelled(const Progress& progress, std::vector<std::uint64_t>& numbers);

} // namespace isotet::core
