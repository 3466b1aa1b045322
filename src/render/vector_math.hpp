// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What cameras need of vectors in space, in double.
#pragma once

#include <array>
#include <cmath>

namespace isotet::render {

using Vector = std::array<double, 3>;

inline Vector plus(const Vector& a, const Vector& b, double times = 1) {
    return {a[0] + times * b[0], a[1] + times * b[1], a[2] + times * b[2]};
}
inline Vector minus(const Vector& a, const Vector& b) { return plus(a, b, -1); }
inline double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vector unit(const Vector& a) {
    const double length = std::sqrt(dot(a, a));
    return {a[0] / length, a[1] / length, a[2] / length};
}

/// `a` turned by `angle` (radians) about a unit axis, counter-clockwise seen from its tip.
inline Vector turned(const Vector& a, const Vector& axis, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    const Vector across = cross(axis, a);
    const double along = dot(axis, a) * (1 - c);
    return {a[0] * c + across[0] * s + axis[0] * along, a[1] * c + across[1] * s + axis[1] * along,
            a[2] * c + across[2] * s + axis[2] * along};
}

} // namespace isotet::render
