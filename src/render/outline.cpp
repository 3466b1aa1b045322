// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/scene.hpp>

#include <cmath>

namespace isotet {

double default_opacity_length(const Box& box) {
    double square = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double length = box.upper[axis] - box.lower[axis];
        square += length * length;
    }
    return 0.1 * std::sqrt(square);
}

DrawnLines outline_of(const Box& box) {
    DrawnLines outline;
    if (box.empty()) return outline;
    const auto corner = [&](unsigned bits) {
        std::array<double, 3> point{};
        for (unsigned axis = 0; axis < 3; ++axis) point[axis] = bits >> axis & 1 ? box.upper[axis] : box.lower[axis];
        return point;
    };
    for (unsigned begin = 0; begin < 8; ++begin)
        for (unsigned axis = 0; axis < 3; ++axis)
            if (!(begin >> axis & 1)) outline.lines.push_back({corner(begin), corner(begin | 1U << axis)});
    return outline;
}

} // namespace isotet
