// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cuts through a grid along planes, spheres and cylinders: isosurfaces of fields that are made of the points.
#pragma once

#include <array>
#include <variant>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// A plane: normal . p = offset.
struct Plane {
    std::array<double, 3> normal{0, 0, 1}; ///< of any length but 0
    double offset = 0;
};

struct Sphere {
    std::array<double, 3> centre{};
    double radius = 1;
};

/// All points at one distance from a line; without ends.
struct Cylinder {
    std::array<double, 3> axis{0, 0, 1}; ///< of any length but 0
    std::array<double, 3> point{};       ///< on the axis
    double radius = 1;
};

using SliceShape = std::variant<Plane, Sphere, Cylinder>;

/// The field whose isosurface at slice_isovalue() is the cut along `shape`: normal . p, the distance from the centre, or
/// that from the axis. Other isovalues cut along parallel planes, and along spheres and cylinders of other radii.
///
///     ContourInput input{grid, *slice_field(grid.points, shape), grid.point_fields, grid.cell_fields};
///     auto session = Contour::create(std::move(input), {.surfaces = 1, .expected_isovalues = {slice_isovalue(shape)}});
///     auto slice = session->extract(slice_isovalue(shape));
///
/// Triangles face along the normal, or outwards. Cuts along planes are flat up to rounding, curved and polyhedral cells
/// included; vertices of other cuts lie on the shape up to the square of the length of their edge.
///
/// `points`   float32 or float64, 3 components
/// Returns    float64, one a point, named after the shape: "z", "distance from (0, 0, 1)"
///
/// Guarantees   computed in float64, in one order: the same bytes on every machine, for any number of threads
/// Cost         one pass over the points; 8 bytes a point
/// Errors       invalid_argument: a number of the shape is not finite, normal or axis is 0, a radius is negative;
///              invalid_data: points of another shape; out_of_memory; cancelled
ISOTET_API Result<PointField> slice_field(const Array& points, const SliceShape& shape, const Run& run = {});

/// Where slice_field() has the shape: the offset, or the radius.
ISOTET_API double slice_isovalue(const SliceShape& shape) noexcept;

} // namespace isotet
