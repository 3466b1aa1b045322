// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cameras by angles and by text.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>

#include <isotet/scene.hpp>

#include "render/vector_math.hpp"

namespace isotet {

namespace {

using render::Vector;

Vector axis_of(UpAxis up) {
    Vector axis{};
    axis[static_cast<std::size_t>(up) / 2] = static_cast<int>(up) % 2 ? -1 : 1;
    return axis;
}

Vector right_angle_to(const Vector& direction, const Vector& up) {
    return render::unit(render::plus(up, direction, -render::dot(up, direction)));
}

std::vector<std::string_view> parts_of(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    while (true) {
        const std::size_t end = text.find(separator);
        parts.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return parts;
        text.remove_prefix(end + 1);
    }
}

std::optional<double> number_of(std::string_view text) {
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) return {};
    return number;
}

std::optional<Vector> vector_of(std::string_view text) {
    const std::vector<std::string_view> parts = parts_of(text, ',');
    if (parts.size() != 3) return {};
    Vector vector{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::optional<double> number = number_of(parts[axis]);
        if (!number) return {};
        vector[axis] = *number;
    }
    return vector;
}

} // namespace

Camera camera_of(View view, UpAxis up, Projection projection) {
    if (view == View::iso) return camera_of(33.69, 25.5, up, projection);
    Camera camera = camera_of(view, projection);
    const Vector axis = axis_of(up);
    if (std::abs(render::dot(axis, camera.direction)) < 0.5) camera.up = axis;
    return camera;
}

Camera camera_of(double azimuth, double elevation, UpAxis up, Projection projection) {
    const Vector axis = axis_of(up);
    const Vector front = std::abs(axis[1]) == 1 ? Vector{0, 0, 1} : Vector{0, -1, 0};
    const Vector right = render::cross(axis, front);
    const double a = azimuth * std::numbers::pi / 180, e = std::clamp(elevation, -90.0, 90.0) * std::numbers::pi / 180;
    const Vector level =
        render::plus({front[0] * std::cos(a), front[1] * std::cos(a), front[2] * std::cos(a)}, right, std::sin(a));
    Camera camera;
    camera.projection = projection;
    camera.direction = render::unit(
        render::plus({level[0] * std::cos(e), level[1] * std::cos(e), level[2] * std::cos(e)}, axis, std::sin(e)));
    const bool at_pole = std::abs(elevation) > 89.9;
    camera.up = at_pole ? right_angle_to(camera.direction, elevation > 0 ? render::minus({}, level) : level)
                        : right_angle_to(camera.direction, axis);
    return camera;
}

std::string to_text(const Camera& camera) {
    const std::string where = fmt::format("{}:{}:{}", fmt::join(camera.target, ","), fmt::join(camera.direction, ","),
                                          fmt::join(camera.up, ","));
    if (camera.projection == Projection::parallel) return fmt::format("parallel:{}:{}", where, camera.height);
    return fmt::format("perspective:{}:{}:{}", where, camera.distance, camera.angle);
}

std::optional<Camera> parse_camera(std::string_view text) {
    const std::vector<std::string_view> parts = parts_of(text, ':');
    const bool parallel = parts[0] == "parallel";
    if ((!parallel && parts[0] != "perspective") || parts.size() != (parallel ? 5U : 6U)) return {};
    const auto target = vector_of(parts[1]), direction = vector_of(parts[2]), up = vector_of(parts[3]);
    const auto size = number_of(parts[4]), angle = parallel ? std::optional(25.0) : number_of(parts[5]);
    if (!target || !direction || !up || !size || !angle || !(*size > 0)) return {};
    const Vector aside = render::cross(*up, *direction);
    if (!(render::dot(aside, aside) > 1e-12 * render::dot(*up, *up) * render::dot(*direction, *direction))) return {};
    Camera camera;
    camera.projection = parallel ? Projection::parallel : Projection::perspective;
    camera.target = *target;
    // What is of unit length and at right angles stays as it is, bit for bit.
    const auto is_unit = [](const Vector& v) { return std::abs(render::dot(v, v) - 1) < 1e-12; };
    camera.direction = is_unit(*direction) ? *direction : render::unit(*direction);
    const bool stays = is_unit(*up) && std::abs(render::dot(*up, camera.direction)) < 1e-12;
    camera.up = stays ? *up : right_angle_to(camera.direction, *up);
    (parallel ? camera.height : camera.distance) = *size;
    if (parallel) camera.distance = 2 * *size;
    camera.angle = *angle;
    return camera;
}

} // namespace isotet
