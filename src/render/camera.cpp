// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/scene.hpp>

#include <algorithm>
#include <array>
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

/// The axis of the world that is up the most: a picture whose horizon is level keeps it when the camera goes about this
/// one.
std::array<double, 3> pole_of(const std::array<double, 3>& up) {
    const auto steepest =
        std::max_element(up.begin(), up.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    std::array<double, 3> pole{};
    pole[static_cast<std::size_t>(steepest - up.begin())] = std::copysign(1.0, *steepest);
    return pole;
}

/// How far something reaches along an axis of the picture, to its two ends, where lines of sight spread by a slope: the
/// place along the axis, plus slope times the way towards the eye.
struct Reach {
    double right = -INFINITY, left = -INFINITY;

    void add(const Reach& other) {
        right = std::max(right, other.right);
        left = std::max(left, other.left);
    }
    double distance(double slope) const { return (right + left) / (2 * slope); } ///< that the eye must keep
    double middle() const { return (right - left) / 2; }
};

/// Points as one camera sees them.
struct FromOneSide {
    std::array<double, 3> right, up, direction;

    explicit FromOneSide(const Camera& camera)
        : right(cross(camera.up, camera.direction)), up(camera.up), direction(camera.direction) {}
    Reach across(const std::array<double, 3>& p, double slope) const { return reach(dot(p, right), p, slope); }
    Reach upwards(const std::array<double, 3>& p, double slope) const { return reach(dot(p, up), p, slope); }

private:
    Reach reach(double place, const std::array<double, 3>& p, double slope) const {
        const double nearer = dot(p, direction) * slope;
        return {place + nearer, -place + nearer};
    }
};

/// Points as a camera sees them that goes all around the pole: each is a circle about it, and reaches as far as the
/// farthest point of the circle. On a circle of radius r, a cos(t) + b sin(t) is at most r times the length of (a, b).
struct FromAllSides {
    std::array<double, 3> pole;
    double sine, cosine; ///< of the angle between direction and horizon

    explicit FromAllSides(const Camera& camera)
        : pole(pole_of(camera.up)), sine(dot(camera.direction, pole)), cosine(dot(camera.up, pole)) {}
    Reach across(const std::array<double, 3>& p, double slope) const {
        const double reach = radius(p) * std::sqrt(1 + slope * cosine * slope * cosine) + dot(p, pole) * slope * sine;
        return {reach, reach};
    }
    Reach upwards(const std::array<double, 3>& p, double slope) const {
        const double r = radius(p), height = dot(p, pole);
        return {height * (slope * sine + cosine) + r * std::abs(slope * cosine - sine),
                height * (slope * sine - cosine) + r * std::abs(slope * cosine + sine)};
    }

private:
    double radius(const std::array<double, 3>& p) const {
        const std::array<double, 3> away = plus(p, pole, -dot(p, pole));
        return std::sqrt(dot(away, away));
    }
};

} // namespace

std::string_view name_of(View view) noexcept { return named_views[static_cast<std::size_t>(view)].name; }

std::optional<View> parse_view(std::string_view name) noexcept {
    for (const NamedView& one : named_views)
        if (one.name == name) return one.view;
    return {};
}

View best_view_of(const Box& box) noexcept {
    constexpr double flat = 1.0 / 20;
    constexpr std::array<View, 3> along{View::plus_x, View::minus_y, View::plus_z};
    std::array<double, 3> extents{};
    for (std::size_t axis = 0; axis < 3; ++axis) extents[axis] = box.upper[axis] - box.lower[axis];
    const std::size_t thin = static_cast<std::size_t>(std::ranges::min_element(extents) - extents.begin());
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (axis != thin && !(extents[thin] < flat * extents[axis])) return View::iso;
    return along[thin];
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
template <class Sight, class EachPoint>
void fit_to(Camera& camera, const Box& around, const EachPoint& each, double aspect, double margin) {
    const Sight sight(camera);
    double widest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) widest = std::max(widest, around.upper[axis] - around.lower[axis]);
    if (!(widest > 0)) widest = 1; // a single point still has a picture
    const double part = 1 - 2 * margin;
    const double slope = std::tan(radians(camera.angle) / 2) * part;
    Reach across, upwards, flat_across, flat_upwards;
    each([&](const std::array<double, 3>& p) {
        across.add(sight.across(p, slope * aspect));
        upwards.add(sight.upwards(p, slope));
        flat_across.add(sight.across(p, 0));
        flat_upwards.add(sight.upwards(p, 0));
    });
    const bool flat = camera.projection == Projection::parallel;
    const double extent = std::max(
        {flat_upwards.right + flat_upwards.left, (flat_across.right + flat_across.left) / aspect, widest * 1e-3});
    camera.height = extent / part;
    camera.distance =
        flat ? 2 * widest : std::max({across.distance(slope * aspect), upwards.distance(slope), widest * 1e-3});
    camera.target =
        plus(plus(middle_of(around), cross(camera.up, camera.direction), (flat ? flat_across : across).middle()),
             camera.up, (flat ? flat_upwards : upwards).middle());
}

template <class Sight>
void fit_to(Camera& camera, const Box& box, double aspect, double margin) {
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
    fit_to<Sight>(camera, around, corners, aspect, margin);
}

template <class Sight>
void fit_to(Camera& camera, const Surface& surface, double aspect, double margin) {
    const Box around = bounds_of(surface);
    if (around.empty()) return fit_to<Sight>(camera, around, aspect, margin);
    const std::array<double, 3> middle = middle_of(around);
    const auto vertices = [&](const auto& add) {
        surface.positions.visit([&](auto positions) {
            for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
                std::array<double, 3> p{};
                for (std::size_t axis = 0; axis < 3; ++axis)
                    p[axis] = static_cast<double>(positions[i + axis]) - middle[axis];
                if (std::isfinite(p[0] + p[1] + p[2])) add(p);
            }
        });
    };
    fit_to<Sight>(camera, around, vertices, aspect, margin);
}

} // namespace

void Camera::fit(const Box& box, double aspect, double margin) { fit_to<FromOneSide>(*this, box, aspect, margin); }

void Camera::fit(const Surface& surface, double aspect, double margin) {
    fit_to<FromOneSide>(*this, surface, aspect, margin);
}

void Camera::fit_orbit(const Box& box, double aspect, double margin) {
    fit_to<FromAllSides>(*this, box, aspect, margin);
}

void Camera::fit_orbit(const Surface& surface, double aspect, double margin) {
    fit_to<FromAllSides>(*this, surface, aspect, margin);
}

void Camera::orbit(double azimuth, double elevation) {
    const std::array<double, 3> pole = pole_of(up);
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
