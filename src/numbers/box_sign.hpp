// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Whether a hexahedron is so near a parallelepiped that all tets it is split into have its orientation.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "numbers/exact.hpp"

namespace isotet::core {

/// +1 or -1 where orientation_sign() of each four corners that make a tet of the cell, whichever diagonals cut it, is that, and
/// six_volumes() has the same sign; 0 where the bound does not tell.
///
/// Of a parallelepiped such determinants are one or two times that of its three edges. A corner that lies up to d aside in an
/// axis moves differences of corners by up to 2 d there, so each of the six products of a determinant is off by what the bound
/// says.
///
/// `corners`   as VTK's hexahedra have them
inline int sign_of_all_tets(const std::array<Point, 8>& corners) {
    const Point& origin = corners[0];
    std::array<Point, 3> edges;
    double longest = 1, moved = 1; // products over the axes
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto at = [&](std::size_t corner) { return corners[corner][axis] - origin[axis]; };
        const double a = at(1), b = at(3), c = at(4);
        const double aside = std::max(std::max(std::abs(at(2) - a - b), std::abs(at(5) - a - c)),
                                      std::max(std::abs(at(7) - b - c), std::abs(at(6) - a - b - c)));
        const double length = std::abs(a) + std::abs(b) + std::abs(c);
        edges[0][axis] = a;
        edges[1][axis] = b;
        edges[2][axis] = c;
        longest *= length;
        moved *= length * (1 + 0x1p-45) + 2 * aside * (1 + 0x1p-40); // more than the roundings here
    }
    const auto& [a, b, c] = edges;
    const double determinant =
        a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    const double bound = 6 * (moved - longest) * (1 + 0x1p-40);
    if (!(std::abs(determinant) > bound && bound > 0x1p-900)) return 0; // products that underflow tell nothing
    return determinant > 0 ? 1 : -1;
}

} // namespace isotet::core
