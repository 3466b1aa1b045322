// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Ranges of groups: the smallest and largest of a byte a point over all corners of 32 tets.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/packed.hpp"

namespace isotet::core {

/// A byte for each local point of a cluster.
using PointSteps = std::array<std::uint8_t, max_cluster_points>;

/// For whole groups, padding included.
/// `lower`, `upper`  the steps whose smallest and whose largest is taken: they differ where points have no data
/// Guarantees        the same on every instruction level (level.hpp)
void find_group_ranges(const StoredTet* tets, std::size_t groups, const PointSteps& lower, const PointSteps& upper,
                       GroupRange* out);

} // namespace isotet::core
