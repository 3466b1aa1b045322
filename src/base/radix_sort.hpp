// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sorting by 64-bit keys, from the highest digit down: a tenth of the comparisons' time where keys are spread, and no
// worse where they are not, since each part looks only at the bits in which its keys differ.
#pragma once

#include <cstdint>
#include <span>

#include <isotet/export.hpp>

namespace isotet::core {

/// Something by its number, on its way to its place.
struct Keyed {
    std::uint64_t key, number;
};

/// Sorts by key; items of equal keys keep their order. Parallel; the same for any thread count.
///
/// `scratch`   as long as `items`; its content is lost
/// Cost        O(n) moves for each digit in which keys differ, three in all for evenly spread keys
ISOTET_API void radix_sort(std::span<Keyed> items, std::span<Keyed> scratch);

} // namespace isotet::core
