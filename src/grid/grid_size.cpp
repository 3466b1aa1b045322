// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/grid_size.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "grid/orientation.hpp"

namespace isotet::core {

namespace {

constexpr double smallest_size = 0x1p-50;

/// The largest of the coordinates, or of their distances from those of the first point; as far as a look is needed to tell
/// that it is not too small.
double largest_until_enough(const Array& array, bool relative) {
    const PointReader points(array);
    Point first{};
    bool has_first = !relative;
    double largest = 0;
    for (std::size_t i = 0; i < array.tuples() && largest < smallest_size; ++i) {
        const Point p = points[i];
        if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2])) continue;
        if (!has_first) first = p;
        has_first = true;
        for (std::size_t axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(p[axis] - first[axis]));
    }
    return largest;
}

double largest_in(const Survey& whole, bool relative) {
    double largest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double lower = whole.lower[axis], upper = whole.upper[axis];
        if (lower > upper) continue;
        largest = std::max(largest, relative ? upper - lower : std::max(std::abs(lower), std::abs(upper)));
    }
    return largest;
}

} // namespace

Result<void> check_grid_size(const Array& points, Precision precision, const Frame* frame) {
    if (points.type() != ScalarType::float32 && points.type() != ScalarType::float64) return {};
    const bool relative = points.type() == ScalarType::float64 && precision == Precision::float32;
    const double largest = frame ? largest_in(frame->whole, relative) : largest_until_enough(points, relative);
    if (largest == 0 || largest >= smallest_size) return {};
    return invalid_data(
        fmt::format("the coordinates of the points {} {:.3g} at most, but what is below 2^-70 (8.5e-22) is taken for 0, so "
                    "it must be 2^-50 (8.9e-16) or more: give them in a smaller unit",
                    relative ? "differ by" : "are", largest));
}

} // namespace isotet::core
