// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The points of a grid along a Hilbert curve.
#pragma once

#include <cstdint>

#include "base/buffer.hpp"
#include "base/radix_sort.hpp"
#include "grid/orientation.hpp"
#include "numbers/bounds.hpp"

namespace isotet::core {

/// The box around the used points. Parallel; the same for any thread count.
Bounds bounds_of_used(const PointReader& points, const Buffer<std::uint8_t>& used);

/// The used points along a Hilbert curve, each with its place there as the key; those of equal keys by number.
/// Parallel; the same for any thread count.
///
/// `used`   by point: 1 when it is used, else 0
/// Cost     32 bytes a used point
Buffer<Keyed> sort_points(const PointReader& points, const Buffer<std::uint8_t>& used);

} // namespace isotet::core
