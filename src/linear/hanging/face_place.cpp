// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/face_place.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "linear/vector.hpp"

namespace isotet::linear {

namespace {

constexpr int max_steps = 20; // of Gauss and Newton; faces that refinement makes take three or four
constexpr double smallest_step = 1e-15;

Point moved_by(const Point& from, double part, const Point& way) {
    return {from[0] + part * way[0], from[1] + part * way[1], from[2] + part * way[2]};
}

/// The change of u and v that brings `rest` nearest to 0.
std::array<double, 2> solved(const Point& along_u, const Point& along_v, const Point& rest) {
    const double uu = dot(along_u, along_u), vv = dot(along_v, along_v), uv = dot(along_u, along_v);
    const double determinant = uu * vv - uv * uv;
    if (!(determinant > 1e-14 * uu * vv)) return {0, 0};
    const double u = dot(along_u, rest), v = dot(along_v, rest);
    return {(u * vv - v * uv) / determinant, (v * uu - u * uv) / determinant};
}

std::array<double, 4> bilinear_weights(double u, double v) {
    return {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
}

FacePlace place_on_quadrilateral(const std::array<Point, 4>& corners, const Point& point) {
    const auto& [a, b, c, d] = corners;
    double u = 0.5, v = 0.5;
    Point rest{};
    for (int step = 0; step <= max_steps; ++step) {
        const auto weights = bilinear_weights(u, v);
        Point at{};
        for (std::size_t i = 0; i < 4; ++i) at = moved_by(at, weights[i], corners[i]);
        rest = minus(point, at);
        if (step == max_steps) break;
        const Point along_u = moved_by(moved_by({}, 1 - v, minus(b, a)), v, minus(c, d));
        const Point along_v = moved_by(moved_by({}, 1 - u, minus(d, a)), u, minus(c, b));
        const auto [du, dv] = solved(along_u, along_v, rest);
        const double next_u = std::clamp(u + du, 0.0, 1.0), next_v = std::clamp(v + dv, 0.0, 1.0);
        const bool stays = std::abs(next_u - u) + std::abs(next_v - v) < smallest_step;
        u = next_u;
        v = next_v;
        if (stays) break;
    }
    return {4, {0, 1, 2, 3}, bilinear_weights(u, v), std::sqrt(dot(rest, rest))};
}

FacePlace place_on_triangle(const std::array<Point, 3>& corners, const Point& point) {
    const auto& [a, b, c] = corners;
    auto [u, v] = solved(minus(b, a), minus(c, a), minus(point, a));
    u = std::clamp(u, 0.0, 1.0);
    v = std::clamp(v, 0.0, 1 - u);
    const Point rest = minus(point, moved_by(moved_by(a, u, minus(b, a)), v, minus(c, a)));
    return {3, {0, 1, 2}, {1 - u - v, u, v}, std::sqrt(dot(rest, rest))};
}

} // namespace

FacePlace place_on_face(std::span<const std::uint64_t> loop, const core::Point& point,
                        const core::PointReader& points) {
    if (loop.size() == 4)
        return place_on_quadrilateral({points[loop[0]], points[loop[1]], points[loop[2]], points[loop[3]]}, point);
    FacePlace best;
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
        FacePlace found = place_on_triangle({points[loop[0]], points[loop[i]], points[loop[i + 1]]}, point);
        if (best.count > 0 && !(found.distance < best.distance)) continue;
        found.corners = {0, i, i + 1};
        best = found;
    }
    return best;
}

FacePlace place_on_edge(const core::Point& from, const core::Point& to, const core::Point& point) {
    const Point along = minus(to, from);
    const double part = std::clamp(dot(minus(point, from), along) / dot(along, along), 0.0, 1.0);
    const Point rest = minus(point, moved_by(from, part, along));
    return {2, {0, 1}, {1 - part, part}, std::sqrt(dot(rest, rest))};
}

} // namespace isotet::linear
