// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <isotet/progress.hpp>

#include "base/buffer.hpp"
#include "grid/orientation.hpp"

namespace isotet::core {

/// How many used points have the coordinates of a used point of a lower number. Incomplete when cancelled.
///
/// `used`   by point: 1 for those that count; their coordinates are finite
/// Cost     each point hashed once and sorted with a few thousand others; 16 bytes a used point
std::uint64_t count_duplicates(const PointReader& points, const Buffer<std::uint8_t>& used, const Progress& progress);

} // namespace isotet::core
