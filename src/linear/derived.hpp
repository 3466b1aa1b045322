// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The value at a derived point.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace isotet::linear {

/// The sum of weight(i) * at(i) for i < count, where weights have the sum 1: by differences to the first value, so that
/// equal values give just that value.
template <class Weight, class At>
double weighted_sum(std::size_t count, const Weight& weight, const At& at) {
    const double first = at(0);
    double sum = 0;
    for (std::size_t i = 1; i < count; ++i) sum += weight(i) * (at(i) - first);
    if (std::isfinite(first + sum)) return first + sum;
    sum = 0; // a difference overflowed, or there are values that are not finite
    for (std::size_t i = 0; i < count; ++i) sum += weight(i) * at(i);
    return sum;
}

/// The value, or the nearest of those from the smallest at(i) to the largest; not a number stays so.
template <class At>
double within(double value, std::size_t count, const At& at) {
    double lower = at(0), upper = lower;
    for (std::size_t i = 1; i < count; ++i) {
        const double next = at(i);
        lower = next < lower ? next : lower;
        upper = next > upper ? next : upper;
    }
    return value < lower ? lower : value > upper ? upper : value;
}

/// Of a point with these weights, or with equal ones where there is one.
template <class At>
double derived_value(std::span<const double> weights, std::size_t count, const At& at) {
    const std::size_t step = weights.size() == count ? 1 : 0;
    return weighted_sum(count, [&](std::size_t i) { return weights[i * step]; }, at);
}

} // namespace isotet::linear
