// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/volume/rays.hpp"

#include <algorithm>
#include <cmath>

namespace isotet::render {

namespace {

/// The vector along a row of which the row is 1.
Vector step_along(const Row& row) {
    const double square = dot(row.along, row.along);
    return {row.along[0] / square, row.along[1] / square, row.along[2] / square};
}

} // namespace

Rays::Rays(const Sight& sight, std::uint32_t width, std::uint32_t height)
    : sight_(sight), width_(width), height_(height), per_x_(step_along(sight.x)), per_y_(step_along(sight.y)) {
    if (sight.parallel) {
        along_ = step_along(sight.z);
        base_ = plus(plus(plus({}, per_x_, -sight.x.shift), per_y_, -sight.y.shift), along_, -sight.z.shift);
        return;
    }
    along_ = step_along(sight.w);
    base_ = sight.eye;
    depth_shift_ = dot(sight.z.along, along_);
    depth_factor_ = sight.z.shift - depth_shift_ * sight.w.shift;
    nearest_ = distance(0);
    farthest_ = distance(1);
}

Ray Rays::at(double x, double y) const {
    const double across = 2 * x / width_ - 1, down = 2 * y / height_ - 1;
    Ray ray;
    if (sight_.parallel) {
        ray.origin = plus(plus(base_, per_x_, across), per_y_, down);
        ray.along = along_;
    } else {
        ray.origin = base_;
        ray.along = plus(plus(along_, per_x_, across), per_y_, down);
    }
    ray.stretch = std::sqrt(dot(ray.along, ray.along));
    return ray;
}

void RayPart::cut(const Ray& ray, const Plane& plane) {
    const double height = dot(plane.normal, ray.origin) - plane.offset, slope = dot(plane.normal, ray.along);
    if (slope == 0) {
        if (height > 0) to = from;
    } else if (slope > 0) {
        to = std::min(to, -height / slope);
    } else {
        from = std::max(from, -height / slope);
    }
}

} // namespace isotet::render
