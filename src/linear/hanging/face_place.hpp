// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where a point is on a face: weights of its corners, and the distance.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "grid/orientation.hpp"

namespace isotet::linear {

/// Up to four corners of a loop, by their places in it, and their weights; the sum of these is 1.
struct FacePlace {
    std::size_t count = 0;
    std::array<std::size_t, 4> corners{};
    std::array<double, 4> weights{};
    double distance = 0; ///< of the point from the place that the weights give
};

/// The nearest place, of a triangle, a quadrilateral as its bilinear map, or a larger loop as the fan from its first
/// corner.
FacePlace place_on_face(std::span<const std::uint64_t> loop, const core::Point& point, const core::PointReader& points);

/// The same on an edge, with two weights.
FacePlace place_on_edge(const core::Point& from, const core::Point& to, const core::Point& point);

} // namespace isotet::linear
