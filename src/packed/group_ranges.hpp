// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Ranges of groups: the smallest and largest of a byte a point over all corners of 32 tets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "packed/packed.hpp"

namespace isotet::core {

/// A byte for each local point of a cluster.
using PointSteps = std::array<std::uint8_t, max_cluster_points>;

/// For the words of one kind of cells; the last group may have less than 32.
/// `lower`, `upper`  the steps whose smallest and whose largest is taken: they differ where points have no data
/// Guarantees        the same on every instruction level (level.hpp)
void find_group_ranges(std::span<const StoredTet> words, const PointSteps& lower, const PointSteps& upper,
                       GroupRange* out);

} // namespace isotet::core
