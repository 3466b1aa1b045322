// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The gradient of the field in one tet, as the gradient at a point is summed from it: in double, in one fixed order.
#pragma once

#include <array>
#include <cstddef>

#include "numbers/exact.hpp"

namespace isotet::core {

/// Six volumes times the gradient of the function that is linear in a tet and has these values at its corners.
inline Point six_volumes_times_gradient(const std::array<Point, 4>& corners, const std::array<double, 4>& values) {
    Point edge[3];
    double rise[3];
    for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t axis = 0; axis < 3; ++axis) edge[k][axis] = corners[k + 1][axis] - corners[0][axis];
        rise[k] = values[k + 1] - values[0];
    }
    const auto cross = [](const Point& a, const Point& b) {
        return Point{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const Point n0 = cross(edge[1], edge[2]), n1 = cross(edge[2], edge[0]), n2 = cross(edge[0], edge[1]);
    Point gradient;
    for (std::size_t axis = 0; axis < 3; ++axis)
        gradient[axis] = rise[0] * n0[axis] + rise[1] * n1[axis] + rise[2] * n2[axis];
    return gradient;
}

} // namespace isotet::core
