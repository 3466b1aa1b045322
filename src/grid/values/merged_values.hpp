// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What fields have at points that become one.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/grid.hpp>

namespace isotet::core {

/// The largest difference of values of points that become one.
///
/// `lowest`   for each point the one that stands for it
double largest_jump(const Array& values, const std::vector<std::uint64_t>& lowest);

/// The values with the mean at all points that become one: of those that are not NaN, in double, in the order of point
/// numbers, rounded once. Integers become float64.
Array with_means(const Array& values, const std::vector<std::uint64_t>& lowest);

} // namespace isotet::core
