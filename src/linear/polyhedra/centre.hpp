// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The derived point around which a polyhedron is split.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "grid/orientation.hpp"

namespace isotet::linear {

/// Point numbers of a triangle, counter-clockwise seen from outside.
using OutwardTriangle = std::array<std::uint64_t, 3>;

struct Centre {
    std::vector<double> weights; ///< of the cell's points, in their order; the sum is 1
    core::Point place{};         ///< as it is stored
    bool moved = false;          ///< not the mean of the points
    bool folded = false;         ///< the mean of the points, and it does not see all triangles
    bool sees_all = false;       ///< the tets over all triangles are upright, those without an area, too
};

/// The mean of the points; where a tet between it and a triangle would not be upright, a point moved towards the inner side
/// of the worst triangles (Agmon 1954; Motzkin, Schoenberg 1954) and the weights of least norm that give it.
///
/// `single`   points are stored as float32: tets are judged with the rounded place
/// Cost       O(triangles), 400 times that where it is moved
Centre find_centre(std::span<const std::uint64_t> points, std::span<const OutwardTriangle> triangles,
                   const core::PointReader& places, bool single);

} // namespace isotet::linear
