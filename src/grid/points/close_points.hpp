// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Points within a distance of each other.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/progress.hpp>

#include "numbers/exact.hpp"

namespace isotet::core {

/// For each point the lowest-numbered point of its chain: points are in one chain when they are at most `tolerance`
/// apart, or when other points of the chain lie between.
///
/// `points`      float32 or float64, 3 components
/// `wanted`      a byte a point: points with 0 are in no chain
/// `lower`       the lower corner of a box around the wanted points, at most 2^40 times the tolerance long
/// `tolerance`   above 0
///
/// Guarantees   the same for any thread count; cancelled, it is of no use
/// Cost         O(n log n), 40 bytes a point; more only where crowds of points are just out of each other's reach
ISOTET_API std::vector<std::uint64_t> lowest_of_chain(const Array& points, const std::vector<std::uint8_t>& wanted,
                                                      const Point& lower, double tolerance,
                                                      const Progress& progress = {});

} // namespace isotet::core
