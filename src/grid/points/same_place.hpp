// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Points with exactly equal coordinates.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/array.hpp>

namespace isotet::core {

/// For each point the lowest-numbered point with the same coordinates (-0 equals +0; NaN equals nothing), itself if
/// there is no other.
///
/// `points`   float32 or float64, 3 components, n tuples
/// `wanted`   null, or n bytes: points with 0 equal nothing
/// Cost       O(n log n), in parallel; 24 bytes a point, 8 of which are the result
std::vector<std::uint64_t> lowest_at_same_place(const Array& points, const std::uint8_t* wanted = nullptr);

} // namespace isotet::core
