// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Quadrilaterals of the boundary that are not flat: where an isovalue cuts one, the triangles of its parts are others than
// those of the whole face, and the volumes of the solids on both sides would not add up to the grid's.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <isotet/array.hpp>

namespace isotet::solid {

using Place3 = std::array<double, 3>;

/// By how much coordinates of this type may be off, as a share of their magnitude.
inline double rounding_of(ScalarType type) { return type == ScalarType::float32 ? 0x1p-21 : 0x1p-50; }

/// A polygon in space.
struct Polygon {
    Place3 mean{};
    Place3 area{};     ///< vector, by the right-hand rule
    double volume = 0; ///< between the origin and triangles from the mean to the sides
};

/// `corners`   at least three
Polygon polygon_of(std::span<const Place3> corners);

/// Whether the corners of a quadrilateral are not in one plane, by more than about `distance`.
bool is_warped(std::span<const Place3, 4> corners, double distance);

/// The largest magnitude of a coordinate.
double largest_coordinate(std::span<const Place3> places);

/// From the mean so far along the area that triangles to this point, in place of the mean, enclose `volume`.
Place3 apex_of(const Polygon& polygon, double volume);

/// What the corners of a quadrilateral that is not flat weigh in a vector: their sum is 0. All 0 where it is flat.
std::array<double, 4> weights_of(std::span<const Place3, 4> corners, const Place3& vector);

/// What the parts of a face on each side enclose, made so that they add up to the whole.
///
/// `whole`   what the triangles of the whole face enclose
/// The difference is shared by the areas to the power of 1.5: the points inside small parts then move as little as these are
/// wide, and no needles come about.
void share_difference(double whole, std::span<const Polygon> parts, std::span<double> volumes);

} // namespace isotet::solid
