// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Errors of a field as distances between surfaces: divided by how steep the field is.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "linear/curved/node_values.hpp"
#include "linear/curved/quadratic.hpp"
#include "linear/vector.hpp"

namespace isotet::linear {

/// The largest error is at most this times the largest deviation at the middle of an edge: the weights' products of a tet
/// sum up to at most 3/8.
inline constexpr double error_per_deviation = 1.5;

/// The length of the gradient that rises by `rise` along three vectors; infinite where these lie in a plane.
inline double slope(const std::array<Point, 3>& along, const std::array<double, 3>& rise) {
    const Point yz = cross(along[1], along[2]), zx = cross(along[2], along[0]), xy = cross(along[0], along[1]);
    const double volume = dot(along[0], yz);
    if (volume == 0) return std::numeric_limits<double>::infinity();
    Point sum{};
    for (std::size_t k = 0; k < 3; ++k) sum[k] = rise[0] * yz[k] + rise[1] * zx[k] + rise[2] * xy[k];
    return std::sqrt(dot(sum, sum)) / std::abs(volume);
}

/// Distances, counted by quarters of powers of two.
class DistanceCounts {
public:
    void add(double distance);
    void add(const DistanceCounts& other);

    double largest() const { return largest_; }
    /// A distance that this share of them do not exceed, at most 2^(1/4) times the least such.
    double not_exceeded_by(double share) const;

private:
    static constexpr int lowest = -200, highest = 200; ///< powers of two
    std::array<std::uint64_t, 4 * (highest - lowest) + 1> counts_{};
    double largest_ = 0;
};

/// For each point what an edge there may deviate, so that the surface is within `distance`: by the least gradient of the
/// quadratic field at the point in the tets around, times the distance, at least `floor`, at most `most`.
std::vector<double> deviations_for(double distance, double floor, double most, const QuadraticTets& tets,
                                   const NodeValues& values, const std::array<NodeValues, 3>& places,
                                   std::uint64_t points);

} // namespace isotet::linear
