// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/camera.hpp>

#include <algorithm>
#include <numbers>

#include "render/vector_math.hpp"

namespace isotet {

using render::cross;
using render::dot;
using render::plus;
using render::turned;
using render::unit;

namespace {

struct NamedView {
    View view;
    std::string_view name;
    std::array<double, 3> direction, up;
};

constexpr std::array<double, 3> x_axis{1, 0, 0}, y_axis{0, 1, 0}, z_axis{0, 0, 1};
constexpr std::array<double, 3> minus_x_axis{-1, 0, 0}, minus_y_axis{0, -1, 0}, minus_z_axis{0, 0, -1};

constexpr std::array<NamedView, 7> named_views{{{View::iso, "iso", {0.5, -0.75, 0.43}, z_axis},
                                                {View::plus_x, "+x", x_axis, z_axis},
                                                {View::minus_x, "-x", minus_x_axis, z_axis},
                                                {View::plus_y, "+y", y_axis, z_axis},
                                                {View::minus_y, "-y", minus_y_axis, z_axis},
                                                {View::plus_z, "+z", z_axis, y_axis},
                                                {View::minus_z, "-z", minus_z_axis, y_axis}}};

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

/// The part of `up` at right angles to `direction`.
std::array<double, 3> upright(const std::array<double, 3>& direction, const std::array<double, 3>& up) {
    return unit(plus(up, direction, -dot(up, direction)));
}

std::array<double, 3> middle_of(const Box& box) {
    std::array<double, 3> middle{};
    for (std::size_t axis = 0; axis < 3; ++axis) middle[axis] = box.lower[axis] / 2 + box.upper[axis] / 2;
    return middle;
}

/// Largest and smallest sums that decide how far away a camera must be for an axis of the picture.
struct Extent {
    double right = -INFINITY, left = -INFINITY;
    void add(double place, double towards_eye, double slope) {
        right = std::max(right, place + towards_eye * slope);
        left = std::max(left, -place + towards_eye * slope);
    }
    double distance(double slope) const { return (right + left) / (2 * slope); }
    double middle() const { return (right - left) / 2; }
};

} // namespace

std::string_view name_of(View view) noexcept { return named_views[static_cast<std::size_t>(view)].name; }

std::optional<View> parse_view(std::string_view name) noexcept {
    for (const NamedView& one : named_views)
        if (one.name == name) return one.view;
    return {};
}

Camera camera_of(View view, Projection projection) {
    const NamedView& named = named_views[static_cast<std::size_t>(view)];
    Camera camera;
    camera.projection = projection;
    camera.direction = unit(named.direction);
    camera.up = upright(camera.direction, named.up);
    return camera;
}

namespace {

/// Fits a camera to points, which `each` hands out one by one, relative to the middle of their box.
template <class EachPoint>
void fit_to(Camera& camera, const Box& around, const EachPoint& each, double aspect, double margin) {
    const std::array<double, 3> right = cross(camera.up, camera.direction);
    double widest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) widest = std::max(widest, around.upper[axis] - around.lower[axis]);
    if (!(widest > 0)) widest = 1; // a single point still has a picture
    const double part = 1 - 2 * margin;
    const double slope = std::tan(radians(camera.angle) / 2) * part;
    Extent across, upwards, flat_across, flat_upwards;
    each([&](const std::array<double, 3>& p) {
        const double x = dot(p, right), y = dot(p, camera.up), z = dot(p, camera.direction);
        across.add(x, z, slope * aspect);
        upwards.add(y, z, slope);
        flat_across.add(x, z, 0);
        flat_upwards.add(y, z, 0);
    });
    const bool flat = camera.projection == Projection::parallel;
    const double extent = std::max(
        {flat_upwards.right + flat_upwards.left, (flat_across.right + flat_across.left) / aspect, widest * 1e-3});
    camera.height = extent / part;
    camera.distance =
        flat ? 2 * widest : std::max({across.distance(slope * aspect), upwards.distance(slope), widest * 1e-3});
    camera.target = plus(plus(middle_of(around), right, (flat ? flat_across : across).middle()), camera.up,
                         (flat ? flat_upwards : upwards).middle());
}

} // namespace

void Camera::fit(const Box& box, double aspect, double margin) {
    const Box around = box.empty() ? Box{{0, 0, 0}, {0, 0, 0}} : box;
    const std::array<double, 3> middle = middle_of(around);
    const auto corners = [&](const auto& add) {
        for (int corner = 0; corner < 8; ++corner) {
            std::array<double, 3> p{};
            for (std::size_t axis = 0; axis < 3; ++axis)
                p[axis] = (corner >> axis & 1 ? around.upper[axis] : around.lower[axis]) - middle[axis];
            add(p);
        }
    };
    fit_to(*this, around, corners, aspect, margin);
}

void Camera::fit(const Surface& surface, double aspect, double margin) {
    const Box around = bounds_of(surface);
    if (around.empty()) return fit(around, aspect, margin);
    const std::array<double, 3> middle = middle_of(around);
    const auto vertices = [&](const auto& add) {
        surface.positions.visit([&](auto positions) {
            for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
                std::array<double, 3> p{};
                for (std::size_t axis = 0; axis < 3; ++axis)
                    p[axis] = static_cast<double>(positions[i + axis]) + (surface.origin[axis] - middle[axis]);
                if (std::isfinite(p[0] + p[1] + p[2])) add(p);
            }
        });
    };
    fit_to(*this, around, vertices, aspect, margin);
}

void Camera::fit_ball(const Box& box, double aspect, double margin) {
    const Box around = box.empty() ? Box{{0, 0, 0}, {0, 0, 0}} : box;
    target = middle_of(around);
    double radius = std::hypot(around.upper[0] - target[0], around.upper[1] - target[1], around.upper[2] - target[2]);
    if (!(radius > 0)) radius = 0.5; // a single point still has a picture
    const double part = 1 - 2 * margin, narrow = std::min(aspect, 1.0);
    height = 2 * radius / (part * narrow);
    distance = projection == Projection::parallel
                   ? 4 * radius
                   : radius / std::sin(std::atan(std::tan(radians(angle) / 2) * part * narrow));
}

void Camera::orbit(double azimuth, double elevation) {
    // About the axis of the world that is up the most: a picture whose horizon is level keeps it.
    const auto steepest =
        std::max_element(up.begin(), up.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    std::array<double, 3> pole{};
    pole[static_cast<std::size_t>(steepest - up.begin())] = std::copysign(1.0, *steepest);
    direction = turned(direction, pole, radians(azimuth));
    up = turned(up, pole, radians(azimuth));
    constexpr double nearly_90 = 89.9;
    const double now = std::asin(std::clamp(dot(direction, pole), -1.0, 1.0)) * 180 / std::numbers::pi;
    const double then = std::clamp(now + elevation, std::min(-nearly_90, now), std::max(nearly_90, now));
    const std::array<double, 3> right = unit(cross(up, direction));
    direction = unit(turned(direction, right, radians(now - then)));
    up = upright(direction, turned(up, right, radians(now - then)));
}

void Camera::zoom(double factor) {
    height /= factor;
    if (projection == Projection::perspective) distance /= factor;
}

} // namespace isotet
