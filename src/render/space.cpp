// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/space.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isotet::render {

namespace {

/// Room before the nearest and behind the farthest point, in the scene.
constexpr double depth_room = 1e-2;
/// Nearest and farthest depth of a perspective picture are at most this far apart: the depth buffer has 24 bits at
/// least.
constexpr double depth_ratio = 1e-4;

Row sum(const Row& a, double times_a, const Row& b, double times_b) {
    return {plus({a.along[0] * times_a, a.along[1] * times_a, a.along[2] * times_a}, b.along, times_b),
            a.shift * times_a + b.shift * times_b};
}

} // namespace

Space::Space(const Box& bounds) {
    if (bounds.empty()) return;
    double widest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        centre_[axis] = bounds.lower[axis] / 2 + bounds.upper[axis] / 2;
        half_[axis] = bounds.upper[axis] / 2 - bounds.lower[axis] / 2;
        widest = std::max(widest, half_[axis]);
    }
    if (widest > 0) scale_ = 1 / widest;
}

std::array<double, 3> Space::place(const std::array<double, 3>& point) const {
    std::array<double, 3> placed{};
    for (std::size_t axis = 0; axis < 3; ++axis) placed[axis] = (point[axis] - centre_[axis]) * scale_;
    return placed;
}

Sight Space::look(const Camera& camera, std::uint32_t width, std::uint32_t height) const {
    const bool flat = camera.projection == Projection::parallel;
    const Vector eye = plus(place(camera.target), camera.direction, camera.distance * scale_);
    const auto row = [&](const Vector& along) { return Row{along, -dot(along, eye)}; };
    const Row right = row(cross(camera.up, camera.direction)), down = row(minus({}, camera.up)),
              depth = row(minus({}, camera.direction));

    double reach = depth_room; // of the bounds along the line of sight
    for (std::size_t axis = 0; axis < 3; ++axis) reach += std::abs(camera.direction[axis]) * half_[axis] * scale_;
    double farthest = depth.shift + reach, nearest = depth.shift - reach;
    if (!flat) {
        farthest = std::max(farthest, depth_room);
        nearest = std::max(nearest, depth_ratio * farthest);
    }
    const Row one{{}, 1};
    const Row w = flat ? one : depth;
    const double size = flat ? camera.height * scale_ / 2 : std::tan(camera.angle * std::numbers::pi / 360);
    const double aspect = static_cast<double>(width) / height;
    const Row x = sum(right, 1 / (size * aspect), one, 0), y = sum(down, 1 / size, one, 0);
    const Row z = sum(depth, 1 / (farthest - nearest), one, -nearest / (farthest - nearest));
    return {x, y, flat ? z : sum(z, farthest, one, 0), w, flat ? camera.direction : eye, flat, camera.up};
}

} // namespace isotet::render
