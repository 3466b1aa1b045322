// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/face_shapes.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "linear/hanging/face_place.hpp"

namespace isotet::linear {

namespace {

constexpr double most_cosine = -0.5; // between the normals
constexpr double flat_face = 1e-7;   // of its extent: what its corners are beside a plane

} // namespace

Point normal_of(std::span<const std::uint64_t> loop, const core::PointReader& points) {
    Point out{};
    const Point origin = points[loop[0]];
    Point at{};
    for (std::size_t i = 1; i < loop.size(); ++i) {
        const Point next = minus(points[loop[i]], origin);
        const Point part = cross(at, next);
        for (std::size_t axis = 0; axis < 3; ++axis) out[axis] += part[axis];
        at = next;
    }
    return out;
}

Point middle_of(std::span<const std::uint64_t> loop, const core::PointReader& points) {
    Point out{};
    for (const std::uint64_t point : loop) {
        const Point at = points[point];
        for (std::size_t axis = 0; axis < 3; ++axis) out[axis] += at[axis] / static_cast<double>(loop.size());
    }
    return out;
}

FaceShapes::FaceShapes(const OpenFaces& faces, const core::CellReader& cells, const core::PointReader& points)
    : faces_(faces), points_(points), shapes_(faces.size()), twice_areas_(faces.size()) {
    core::parallel_each(faces.size(), 1 << 10, [&](std::size_t face) {
        shapes_[face] = shape_of(face, cells);
        twice_areas_[face] = std::sqrt(dot(shapes_[face].normal, shapes_[face].normal));
        shapes_[face].is_flat = is_flat(shapes_[face], faces_.loop(face), twice_areas_[face]);
    });
}

FaceShapes::Shape FaceShapes::shape_of(std::size_t face, const core::CellReader& cells) const {
    const auto loop = faces_.loop(face);
    Shape out;
    out.normal = normal_of(loop, points_);
    out.middle = middle_of(loop, points_);
    Point lower = points_[loop[0]], upper = lower;
    for (const std::uint64_t point : loop) {
        const Point at = points_[point];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], at[axis]);
            upper[axis] = std::max(upper[axis], at[axis]);
        }
    }
    out.extent = std::sqrt(core::squared_distance(lower, upper));
    const std::uint64_t cell = faces_.place(face).cell, first = cells.first(cell), count = cells.corners(cell);
    Point inside{};
    for (std::uint64_t i = 0; i < count; ++i) {
        const Point at = points_[cells.corner(first + i)];
        for (std::size_t axis = 0; axis < 3; ++axis) inside[axis] += at[axis] / static_cast<double>(count);
    }
    out.is_turned = dot(out.normal, minus(out.middle, inside)) < 0;
    if (out.is_turned)
        for (double& x : out.normal) x = -x;
    return out;
}

bool FaceShapes::is_flat(const Shape& shape, std::span<const std::uint64_t> loop, double twice_area) const {
    return std::ranges::all_of(loop, [&](std::uint64_t point) {
        const double height = dot(minus(points_[point], shape.middle), shape.normal);
        return std::abs(height) <= flat_face * shape.extent * twice_area;
    });
}

bool FaceShapes::looks_at(std::size_t face, std::size_t other) const {
    const Shape &shape = shapes_[face], &small = shapes_[other];
    const double twice_area = twice_areas_[face];
    if (!(dot(shape.normal, small.normal) < most_cosine * twice_area * twice_areas_[other])) return false;
    if (faces_.place(face).cell == faces_.place(other).cell) return false;
    const auto loop = faces_.loop(face);
    Point at = points_[loop.back()];
    for (const std::uint64_t point : loop) {
        const Point next = points_[point];
        const double inside = dot(cross(minus(next, at), minus(small.middle, at)), shape.normal);
        if (shape.is_turned ? inside > 0 : inside < 0) return false;
        at = next;
    }
    const double height = std::abs(dot(minus(small.middle, shape.middle), shape.normal)) / twice_area;
    return height <= 2 * beside_face * shape.extent;
}

double FaceShapes::distance(std::size_t face, std::size_t other) const {
    const Shape& shape = shapes_[face];
    const Point& middle = shapes_[other].middle;
    if (!shape.is_flat) return place_on_face(faces_.loop(face), middle, points_).distance / shape.extent;
    return std::abs(dot(minus(middle, shape.middle), shape.normal)) / (twice_areas_[face] * shape.extent);
}

} // namespace isotet::linear
