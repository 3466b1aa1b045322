// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Boxes around grids and surfaces.
#include <algorithm>
#include <cmath>
#include <mutex>

#include <isotet/scene.hpp>

#include "base/parallel.hpp"
#include "packed/packed.hpp"
#include "packed/residency.hpp"

namespace isotet {

void Box::add(const std::array<double, 3>& point) noexcept {
    if (empty()) {
        lower = upper = point;
        return;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        lower[axis] = std::min(lower[axis], point[axis]);
        upper[axis] = std::max(upper[axis], point[axis]);
    }
}

void Box::add(const Box& other) noexcept {
    if (other.empty()) return;
    add(other.lower);
    add(other.upper);
}

namespace {

/// `positions`   three scalars a point; points that are not finite are passed over
template <class Positions>
Box bounds_of_positions(const Positions& positions, const std::array<double, 3>& origin) {
    constexpr std::size_t grain = std::size_t{1} << 16;
    Box box;
    std::mutex mutex;
    core::parallel_ranges(positions.size() / 3, grain, [&](std::size_t begin, std::size_t end) {
        Box part;
        for (std::size_t i = begin; i < end; ++i) {
            const std::array<double, 3> point{static_cast<double>(positions[3 * i]),
                                              static_cast<double>(positions[3 * i + 1]),
                                              static_cast<double>(positions[3 * i + 2])};
            if (std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2])) part.add(point);
        }
        const std::lock_guard lock(mutex);
        box.add(part);
    });
    if (box.empty()) return box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] += origin[axis];
        box.upper[axis] += origin[axis];
    }
    return box;
}

} // namespace

Box bounds_of(const PackedGrid& packed) {
    const auto whole = core::whole_of(packed.shared_data(), {});
    if (!whole) return {};
    const core::Packed& data = **whole;
    return std::visit([&](const auto& reals) { return bounds_of_positions(reals.positions, data.origin); }, data.reals);
}

Box bounds_of(const Surface& surface) {
    return surface.positions.visit([&](auto positions) { return bounds_of_positions(positions, {}); });
}

} // namespace isotet
