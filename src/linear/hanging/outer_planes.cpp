// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/outer_planes.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/parallel.hpp"
#include "grid/orientation.hpp"
#include "linear/vector.hpp"

namespace isotet::linear {

namespace {

constexpr std::size_t most_planes = 16;
constexpr double same_normal = 1 - 1e-6; // the cosine between normals of faces in one plane, which are small
constexpr double near_plane = 2e-3; // of the distance: how far the middle of a face in the same plane may be beside it

Point with_length_1(const Point& a) {
    const double length = std::sqrt(dot(a, a));
    return {a[0] / length, a[1] / length, a[2] / length};
}

/// A plane through points, by least squares of their heights over a plane near it.
class FittedPlane {
public:
    /// `normal`   of length 1, outward
    FittedPlane(const Point& normal, const Point& origin) : normal_(normal), origin_(origin) {
        std::size_t least = 0;
        for (std::size_t axis = 1; axis < 3; ++axis)
            if (std::abs(normal[axis]) < std::abs(normal[least])) least = axis;
        Point along{};
        along[least] = 1;
        first_ = with_length_1(cross(normal, along));
        second_ = cross(normal, first_);
    }

    bool is_near(const FaceShape& face) const {
        const Point from = minus(face.middle, origin_);
        return dot(normal_, face.normal) > same_normal * face.twice_area &&
               std::abs(dot(normal_, from)) <= near_plane * std::sqrt(dot(from, from));
    }

    void add(const Point& at) {
        const Point from = minus(at, origin_);
        const std::array<double, 4> terms{1, dot(first_, from), dot(second_, from), dot(normal_, from)};
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = i; j < 4; ++j) sums_[i][j] += terms[i] * terms[j];
    }

    /// When all were added. False where they are on a line.
    bool fit() {
        const double count = sums_[0][0];
        const auto about_mean = [&](std::size_t i, std::size_t j) {
            return sums_[i][j] - sums_[0][i] * sums_[0][j] / count;
        };
        const double uu = about_mean(1, 1), uv = about_mean(1, 2), vv = about_mean(2, 2);
        const double determinant = uu * vv - uv * uv;
        if (!(determinant > 1e-12 * (uu + vv) * (uu + vv))) return false;
        const double uw = about_mean(1, 3), vw = about_mean(2, 3);
        const double slope = (uw * vv - vw * uv) / determinant, other = (vw * uu - uw * uv) / determinant;
        const std::array<double, 3> mean{sums_[0][1] / count, sums_[0][2] / count, sums_[0][3] / count};
        Point normal = normal_;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin_[axis] += mean[0] * first_[axis] + mean[1] * second_[axis] + mean[2] * normal_[axis];
            normal[axis] -= slope * first_[axis] + other * second_[axis];
        }
        normal_ = with_length_1(normal);
        level_ = dot(normal_, origin_);
        spread_ = {vv / determinant, -uv / determinant, uu / determinant};
        return true;
    }

    const Point& normal() const { return normal_; }
    double level() const { return level_; }
    double height(const Point& at) const { return dot(normal_, minus(at, origin_)); }
    /// What an error of 1 at the points of the fit may be at a place, and its own.
    double error_at(const Point& at) const {
        const Point from = minus(at, origin_);
        const double u = dot(first_, from), v = dot(second_, from);
        return std::sqrt(1 + spread_[0] * u * u + 2 * spread_[1] * u * v + spread_[2] * v * v);
    }

private:
    Point normal_, origin_, first_, second_;
    double level_ = 0;
    std::array<std::array<double, 4>, 4> sums_{};
    std::array<double, 3> spread_{}; ///< the inverse of the sums of products in the plane
};

double largest_of(const Point& at) { return std::max({std::abs(at[0]), std::abs(at[1]), std::abs(at[2])}); }

/// Faces by planes; nothing where these are many.
std::vector<FittedPlane> planes_of(const OpenFaces& faces, const FaceShapes& shapes, const core::PointReader& points,
                                   std::vector<std::uint8_t>& plane_of_face) {
    std::vector<FittedPlane> planes;
    for (std::size_t face = 0; face < faces.size(); ++face) {
        const FaceShape& shape = shapes[face];
        if (!(shape.twice_area > 0)) return {};
        const auto found = std::ranges::find_if(planes, [&](const FittedPlane& plane) { return plane.is_near(shape); });
        plane_of_face.push_back(static_cast<std::uint8_t>(found - planes.begin()));
        if (found == planes.end()) {
            if (planes.size() == most_planes) return {};
            planes.emplace_back(with_length_1(shape.normal), shape.middle);
        }
        for (const std::uint64_t point : faces.loop(face)) planes[plane_of_face.back()].add(points[point]);
    }
    return planes;
}

/// Whether a point is beyond a plane, by more than `rounding` of coordinates may have put it there.
class Beyond {
public:
    Beyond(std::span<const FittedPlane> planes, double largest, double rounding)
        : planes_(planes), largest_(largest), rounding_(rounding) {}

    bool is_beyond(const FittedPlane& plane, const Point& at) const {
        const double height = plane.height(at);
        return height > 0 && height > may_be(plane, at);
    }
    bool is_beside(const FittedPlane& plane, const Point& at) const {
        return std::abs(plane.height(at)) > may_be(plane, at);
    }

    template <class Real>
    bool is_some(std::span<const Real> all) const {
        constexpr std::size_t together = 512;
        std::array<std::array<double, together>, 3> at;
        for (std::size_t begin = 0; begin < all.size(); begin += 3 * together) {
            const std::size_t count = std::min(together, (all.size() - begin) / 3);
            for (std::size_t i = 0; i < count; ++i)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    at[axis][i] = static_cast<double>(all[begin + 3 * i + axis]);
            for (const FittedPlane& plane : planes_) {
                const Point normal = plane.normal();
                const double level = plane.level() + rounding_ * largest_; // no less may be
                unsigned above = 0;
                for (std::size_t i = 0; i < count; ++i)
                    above |= static_cast<unsigned>(normal[0] * at[0][i] + normal[1] * at[1][i] + normal[2] * at[2][i] >
                                                   level);
                for (std::size_t i = 0; above != 0 && i < count; ++i)
                    if (is_beyond(plane, {at[0][i], at[1][i], at[2][i]})) return true;
            }
        }
        return false;
    }

private:
    double may_be(const FittedPlane& plane, const Point& at) const {
        return rounding_ * std::max(largest_, largest_of(at)) * plane.error_at(at);
    }

    std::span<const FittedPlane> planes_;
    double largest_, rounding_;
};

} // namespace

bool are_outermost(const OpenFaces& faces, const FaceShapes& shapes, const Array& points) {
    const core::PointReader reader(points);
    std::vector<std::uint8_t> plane_of_face;
    std::vector<FittedPlane> planes = planes_of(faces, shapes, reader, plane_of_face);
    if (planes.empty() || !std::ranges::all_of(planes, [](FittedPlane& plane) { return plane.fit(); })) return false;
    double largest = 0;
    for (std::size_t face = 0; face < faces.size(); ++face)
        for (const std::uint64_t point : faces.loop(face)) largest = std::max(largest, largest_of(reader[point]));
    const Beyond beyond(planes, largest, points.type() == ScalarType::float32 ? 0x1p-22 : 0x1p-50);
    for (std::size_t face = 0; face < faces.size(); ++face)
        for (const std::uint64_t point : faces.loop(face))
            if (beyond.is_beside(planes[plane_of_face[face]], reader[point])) return false;
    std::atomic<bool> found{false};
    const auto look = [&](auto all) {
        core::parallel_ranges(points.tuples(), 1 << 13, [&](std::size_t begin, std::size_t end) {
            if (!found.load(std::memory_order_relaxed) && beyond.is_some(all.subspan(3 * begin, 3 * (end - begin))))
                found.store(true, std::memory_order_relaxed);
        });
    };
    if (points.type() == ScalarType::float32) look(points.as<float>());
    else look(points.as<double>());
    return !found;
}

} // namespace isotet::linear
