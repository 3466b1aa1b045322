// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/pick.hpp"

#include <algorithm>
#include <cmath>

namespace isotet::view {

namespace {

using PickPoint = std::array<double, 3>;

PickPoint pick_minus(const PickPoint& a, const PickPoint& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double pick_dot(const PickPoint& a, const PickPoint& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Weights of the corners of a triangle at its point nearest to `p` (Ericson, Real-Time Collision Detection, 5.1.5).
PickPoint nearest_weights(const PickPoint& a, const PickPoint& b, const PickPoint& c, const PickPoint& p) {
    const PickPoint ab = pick_minus(b, a), ac = pick_minus(c, a), ap = pick_minus(p, a);
    const double d1 = pick_dot(ab, ap), d2 = pick_dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const PickPoint bp = pick_minus(p, b);
    const double d3 = pick_dot(ab, bp), d4 = pick_dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    const PickPoint cp = pick_minus(p, c);
    const double d5 = pick_dot(ab, cp), d6 = pick_dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - w, w};
    }
    const double sum = va + vb + vc;
    return {va / sum, vb / sum, vc / sum};
}

struct NearestTriangle {
    std::size_t triangle = 0;
    std::array<std::size_t, 3> corners{};
    PickPoint weights{}, place{};
    double distance = INFINITY; ///< squared
};

/// Calls work(positions, corners) with the arrays of a surface.
template <class Work>
void with_arrays(const Surface& surface, const Work& work) {
    const auto with_corners = [&](auto positions) {
        if (surface.triangles.type() == ScalarType::uint64) work(positions, surface.triangles.as<std::uint64_t>());
        else work(positions, surface.triangles.as<std::uint32_t>());
    };
    if (surface.positions.type() == ScalarType::float32) with_corners(surface.positions.as<float>());
    else with_corners(surface.positions.as<double>());
}

NearestTriangle nearest_triangle(const Surface& surface, const PickPoint& point) {
    NearestTriangle nearest;
    with_arrays(surface, [&](auto positions, auto corners) {
        for (std::size_t i = 0; i < surface.triangle_count(); ++i) {
            std::array<std::size_t, 3> of{};
            std::array<PickPoint, 3> at{};
            for (std::size_t k = 0; k < 3; ++k) {
                of[k] = static_cast<std::size_t>(corners[3 * i + k]);
                for (std::size_t axis = 0; axis < 3; ++axis)
                    at[k][axis] = static_cast<double>(positions[3 * of[k] + axis]);
            }
            const PickPoint weights = nearest_weights(at[0], at[1], at[2], point);
            PickPoint place{};
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t axis = 0; axis < 3; ++axis) place[axis] += weights[k] * at[k][axis];
            const PickPoint away = pick_minus(place, point);
            const double distance = pick_dot(away, away);
            if (distance < nearest.distance) nearest = {i, of, weights, place, distance};
        }
    });
    return nearest;
}

} // namespace

std::optional<Picked> nearest_on(const Surface& surface, const std::array<double, 3>& point) {
    const NearestTriangle nearest = nearest_triangle(surface, point);
    if (!std::isfinite(nearest.distance)) return std::nullopt;
    Picked picked;
    picked.point = nearest.place;
    for (const Field& field : surface.point_fields) {
        PickedValue& value = picked.values.emplace_back(PickedValue{field.name, false, {}});
        field.values.visit([&](auto scalars) {
            const std::size_t components = field.values.components();
            for (std::size_t c = 0; c < components; ++c) {
                double sum = 0;
                for (std::size_t k = 0; k < 3; ++k)
                    if (nearest.weights[k] != 0)
                        sum += nearest.weights[k] * static_cast<double>(scalars[nearest.corners[k] * components + c]);
                value.values.push_back(sum);
            }
        });
    }
    for (const Field& field : surface.cell_fields) {
        PickedValue& value = picked.values.emplace_back(PickedValue{field.name, true, {}});
        field.values.visit([&](auto scalars) {
            const std::size_t components = field.values.components();
            for (std::size_t c = 0; c < components; ++c)
                value.values.push_back(static_cast<double>(scalars[nearest.triangle * components + c]));
        });
    }
    if (!surface.source_cells.empty())
        if (const std::int64_t cell = surface.source_cells.as<std::int64_t>()[nearest.triangle]; cell >= 0)
            picked.cell = cell;
    return picked;
}

std::optional<double> first_on_ray(const Surface& surface, const std::array<double, 3>& origin,
                                   const std::array<double, 3>& direction, std::span<const Plane> clips) {
    const auto cross = [](const PickPoint& a, const PickPoint& b) {
        return PickPoint{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const auto is_clipped = [&](double along) {
        PickPoint place = origin;
        for (std::size_t axis = 0; axis < 3; ++axis) place[axis] += along * direction[axis];
        return std::ranges::any_of(clips,
                                   [&](const Plane& plane) { return pick_dot(plane.normal, place) > plane.offset; });
    };
    double first = INFINITY;
    with_arrays(surface, [&](auto positions, auto corners) {
        for (std::size_t i = 0; i < surface.triangle_count(); ++i) {
            std::array<PickPoint, 3> at{};
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    at[k][axis] =
                        static_cast<double>(positions[3 * static_cast<std::size_t>(corners[3 * i + k]) + axis]);
            // Moller, Trumbore 1997.
            const PickPoint e1 = pick_minus(at[1], at[0]), e2 = pick_minus(at[2], at[0]);
            const PickPoint p = cross(direction, e2), from = pick_minus(origin, at[0]), q = cross(from, e1);
            const double determinant = pick_dot(e1, p);
            if (determinant == 0) continue;
            const double u = pick_dot(from, p) / determinant, v = pick_dot(direction, q) / determinant;
            const double along = pick_dot(e2, q) / determinant;
            const bool inside = u >= 0 && v >= 0 && u + v <= 1;
            if (inside && along > 0 && along < first && !is_clipped(along)) first = along;
        }
    });
    return std::isfinite(first) ? std::optional(first) : std::nullopt;
}

} // namespace isotet::view
