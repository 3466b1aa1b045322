// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Signs computed exactly: a floating-point filter first, expansions (sums of doubles that do not overlap) where it
// fails. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates (1997).
#pragma once

#include <array>
#include <cmath>

namespace isotet::core {

using Point = std::array<double, 3>;

/// What orientation_sign() says, by expansions alone.
int exact_orientation_sign(const Point& a, const Point& b, const Point& c, const Point& d);

/// The sign of (b - a) . ((c - a) x (d - a)): +1 when the tet a b c d is upright, -1 when it is inverted, 0 when it is
/// flat.
///
/// Guarantees   exact for all coordinates below 2^91, unless parts smaller than 2^-1000 of the largest decide
inline int orientation_sign(const Point& a, const Point& b, const Point& c, const Point& d) {
    const double bx = b[0] - a[0], by = b[1] - a[1], bz = b[2] - a[2];
    const double cx = c[0] - a[0], cy = c[1] - a[1], cz = c[2] - a[2];
    const double dx = d[0] - a[0], dy = d[1] - a[1], dz = d[2] - a[2];
    const double determinant = bx * (cy * dz - cz * dy) + by * (cz * dx - cx * dz) + bz * (cx * dy - cy * dx);
    // Shewchuk's bound for orient3d: (7 + 56 eps) eps times the permanent, eps = 2^-53.
    const double permanent = (std::abs(cy * dz) + std::abs(cz * dy)) * std::abs(bx) +
                             (std::abs(cz * dx) + std::abs(cx * dz)) * std::abs(by) +
                             (std::abs(cx * dy) + std::abs(cy * dx)) * std::abs(bz);
    constexpr double epsilon = 0x1p-53;
    const double bound = (7.0 + 56.0 * epsilon) * epsilon * permanent;
    // The filter holds while no product underflows.
    if (std::abs(determinant) > bound && bound > 0x1p-900) return determinant > 0 ? 1 : -1;
    return exact_orientation_sign(a, b, c, d);
}

/// True when the triangle a b c has area exactly zero.
bool is_collinear(const Point& a, const Point& b, const Point& c);

/// Six times the volume of a tet, rounded: positive when it is upright.
inline double squared_distance(const Point& a, const Point& b) {
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

inline double six_volumes(const Point& a, const Point& b, const Point& c, const Point& d) {
    const double bx = b[0] - a[0], by = b[1] - a[1], bz = b[2] - a[2];
    const double cx = c[0] - a[0], cy = c[1] - a[1], cz = c[2] - a[2];
    const double dx = d[0] - a[0], dy = d[1] - a[1], dz = d[2] - a[2];
    return bx * (cy * dz - cz * dy) + by * (cz * dx - cx * dz) + bz * (cx * dy - cy * dx);
}

} // namespace isotet::core
