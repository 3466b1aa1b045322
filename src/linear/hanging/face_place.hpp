// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where a point is on a face: weights of its corners, and the distance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "grid/orientation.hpp"

namespace isotet::linear {

struct FacePlace {
    std::vector<double> weights; ///< of the corners, in their order; the sum is 1
    double distance = 0;         ///< of the point from the place that the weights give
};

/// The nearest place, of a triangle, a quadrilateral as its bilinear map, or a larger loop as the fan from its first
/// corner.
FacePlace place_on_face(std::span<const std::uint64_t> loop, const core::Point& point, const core::PointReader& points);

/// The same on an edge, with two weights.
FacePlace place_on_edge(const core::Point& from, const core::Point& to, const core::Point& point);

} // namespace isotet::linear
