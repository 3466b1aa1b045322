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

namespace {

bool is_flat(const FaceShape& shape, std::span<const std::uint64_t> loop, const core::PointReader& points) {
    return std::ranges::all_of(loop, [&](std::uint64_t point) {
        const double height = dot(minus(points[point], shape.middle), shape.normal);
        return std::abs(height) <= flat_face * shape.extent * shape.twice_area;
    });
}

} // namespace

FaceShape shape_of(std::span<const std::uint64_t> loop, const Point& inside, const core::PointReader& points) {
    FaceShape out;
    out.normal = normal_of(loop, points);
    out.twice_area = std::sqrt(dot(out.normal, out.normal));
    out.middle = middle_of(loop, points);
    Point lower = points[loop[0]], upper = lower;
    for (const std::uint64_t point : loop) {
        const Point at = points[point];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], at[axis]);
            upper[axis] = std::max(upper[axis], at[axis]);
        }
    }
    out.extent = std::sqrt(core::squared_distance(lower, upper));
    out.is_turned = dot(out.normal, minus(out.middle, inside)) < 0;
    if (out.is_turned)
        for (double& x : out.normal) x = -x;
    out.is_flat = is_flat(out, loop, points);
    return out;
}

bool is_over(const FaceShape& face, std::span<const std::uint64_t> loop, const FaceShape& small,
             const core::PointReader& points) {
    const double areas = face.twice_area * small.twice_area;
    if (!(small.twice_area < largest_share * face.twice_area)) return false;
    if (!(dot(face.normal, small.normal) < most_cosine * areas)) return false;
    Point at = points[loop.back()];
    for (const std::uint64_t point : loop) {
        const Point next = points[point];
        const double inside = dot(cross(minus(next, at), minus(small.middle, at)), face.normal);
        if (face.is_turned ? inside > 0 : inside < 0) return false;
        at = next;
    }
    const double height = std::abs(dot(minus(small.middle, face.middle), face.normal)) / face.twice_area;
    return height <= 2 * beside_face * face.extent;
}

double distance(const FaceShape& face, std::span<const std::uint64_t> loop, const FaceShape& small,
                const core::PointReader& points) {
    if (!face.is_flat) return place_on_face(loop, small.middle, points).distance / face.extent;
    return std::abs(dot(minus(small.middle, face.middle), face.normal)) / (face.twice_area * face.extent);
}

FaceShapes::FaceShapes(const OpenFaces& faces, const core::CellReader& cells, const core::PointReader& points)
    : faces_(faces), points_(points), shapes_(faces.size()), twice_areas_(faces.size()) {
    core::parallel_each(faces.size(), 1 << 10, [&](std::size_t face) {
        const std::uint64_t cell = faces.place(face).cell, first = cells.first(cell), count = cells.corners(cell);
        Point inside{};
        for (std::uint64_t i = 0; i < count; ++i) {
            const Point at = points[cells.corner(first + i)];
            for (std::size_t axis = 0; axis < 3; ++axis) inside[axis] += at[axis] / static_cast<double>(count);
        }
        shapes_[face] = shape_of(faces.loop(face), inside, points);
        twice_areas_[face] = shapes_[face].twice_area;
    });
}

} // namespace isotet::linear
