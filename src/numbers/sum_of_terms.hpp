// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sums that pieces of a grid have alike: the order in which terms come does not matter.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "numbers/exact.hpp"

namespace isotet::core {

/// Sorts the terms by value, axis by axis, and adds them up.
inline Point sum_of_terms(std::vector<Point>& terms) {
    Point sum{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::sort(terms.begin(), terms.end(), [axis](const Point& a, const Point& b) { return a[axis] < b[axis]; });
        for (const Point& term : terms) sum[axis] += term[axis];
    }
    return sum;
}

} // namespace isotet::core
