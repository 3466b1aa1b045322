// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cameras: fitting, going around, views. No device.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <isotet/scene.hpp>

#include "render/vector_math.hpp"

namespace isotet::test {
namespace {

using render::cross;
using render::dot;
using render::minus;
using render::plus;

constexpr View all_views[] = {View::iso,     View::plus_x, View::minus_x, View::plus_y,
                              View::minus_y, View::plus_z, View::minus_z};

/// How far a point lies from the middle of the picture: 1 at its edges.
std::array<double, 2> seen(const Camera& camera, double aspect, const std::array<double, 3>& point) {
    const auto eye = plus(camera.target, camera.direction, camera.distance);
    const auto from_eye = minus(point, eye);
    const double depth = -dot(from_eye, camera.direction);
    const double half = camera.projection == Projection::parallel
                            ? camera.height / 2
                            : depth * std::tan(camera.angle * std::numbers::pi / 360);
    return {dot(from_eye, cross(camera.up, camera.direction)) / (half * aspect), dot(from_eye, camera.up) / half};
}

/// The largest and smallest places of the corners of a box.
struct Places {
    double left = 9, right = -9, lower = 9, upper = -9;
};
Places places_of(const Camera& camera, double aspect, const Box& box) {
    Places places;
    for (int corner = 0; corner < 8; ++corner) {
        std::array<double, 3> point{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            point[axis] = corner >> axis & 1 ? box.upper[axis] : box.lower[axis];
        const auto [x, y] = seen(camera, aspect, point);
        places.left = std::min(places.left, x);
        places.right = std::max(places.right, x);
        places.lower = std::min(places.lower, y);
        places.upper = std::max(places.upper, y);
    }
    return places;
}

TEST(Camera, SeesTheWholeBoxAsLargeAsItCan) {
    const Box box{{-3, 1, 1000}, {4, 2, 1003}};
    for (const Projection projection : {Projection::perspective, Projection::parallel}) {
        for (const View view : all_views) {
            for (const double aspect : {0.5, 1.0, 2.0}) {
                Camera camera = camera_of(view, projection);
                camera.fit(box, aspect, 0.05);
                const Places places = places_of(camera, aspect, box);
                EXPECT_NEAR(std::max({-places.left, places.right, -places.lower, places.upper}), 0.9, 0.02)
                    << name_of(view) << aspect;
                EXPECT_NEAR(places.left + places.right, 0, 0.1) << name_of(view);
                EXPECT_NEAR(places.lower + places.upper, 0, 0.1) << name_of(view);
            }
        }
    }
}

TEST(Camera, LooksAtFlatBoxesAlongTheirThinAxis) {
    EXPECT_EQ(best_view_of({{0, 0, 0}, {1, 1, 0.01}}), View::plus_z);
    EXPECT_EQ(best_view_of({{0, 5, 0}, {1, 5, 2}}), View::minus_y);
    EXPECT_EQ(best_view_of({{0, 0, 0}, {1, 100, 60}}), View::plus_x);
    EXPECT_EQ(best_view_of({{0, 0, 0}, {1, 1, 0.06}}), View::iso);
    EXPECT_EQ(best_view_of({{0, 0, 0}, {100, 1, 1}}), View::iso) << "a rod has no thin axis";
    EXPECT_EQ(best_view_of({{2, 2, 2}, {2, 2, 2}}), View::iso);
}

TEST(Camera, SeesBoxesWithoutSize) {
    for (const Box& box : {Box{{2, 2, 2}, {2, 2, 2}}, Box{}, Box{{0, 0, 0}, {0, 5, 0}}}) {
        for (const Projection projection : {Projection::perspective, Projection::parallel}) {
            Camera camera = camera_of(View::plus_x, projection);
            camera.fit(box, 1);
            EXPECT_TRUE(camera.distance > 0 && std::isfinite(camera.distance));
            EXPECT_TRUE(camera.height > 0 && std::isfinite(camera.height));
        }
    }
}

TEST(Camera, GoesAllTheWayAround) {
    for (const View view : all_views) {
        const Camera start = camera_of(view);
        Camera camera = start;
        for (int i = 0; i < 36; ++i) camera.orbit(10, 0);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(camera.direction[axis], start.direction[axis], 1e-9) << name_of(view);
            EXPECT_NEAR(camera.up[axis], start.up[axis], 1e-9) << name_of(view);
        }
    }
}

TEST(Camera, StopsBelowThePole) {
    Camera camera = camera_of(View::plus_x);
    camera.orbit(0, 30);
    EXPECT_NEAR(camera.direction[2], 0.5, 1e-9);
    camera.orbit(0, 1000);
    EXPECT_GT(camera.direction[2], 0.999);
    EXPECT_GT(camera.up[2], 0);
    EXPECT_NEAR(dot(camera.up, camera.direction), 0, 1e-9);
    EXPECT_NEAR(dot(camera.up, camera.up), 1, 1e-9);
}

TEST(Camera, ZoomsByAFactor) {
    const std::array<double, 3> point{0, 0.3, 0.4};
    for (const Projection projection : {Projection::perspective, Projection::parallel}) {
        Camera camera = camera_of(View::plus_x, projection);
        camera.fit({{-1, -1, -1}, {1, 1, 1}}, 1);
        camera.target = {};
        const auto before = seen(camera, 1, point);
        camera.zoom(2);
        EXPECT_NEAR(seen(camera, 1, point)[1], 2 * before[1], 1e-9);
    }
}

TEST(Views, HaveNamesThatLeadBack) {
    for (const View view : all_views) EXPECT_EQ(parse_view(name_of(view)), view);
    EXPECT_FALSE(parse_view("x"));
}

/// A needle at a slant and something beside it, far from the middle of their box.
Surface slanting_surface() {
    Surface surface;
    surface.positions = Array::own(std::vector<float>{-3, 1, 0, 5, 2, 0.5F, 4.5F, 1, -2, 4, 1.5F, 0.25F}, 3);
    surface.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 2, 1, 2, 3}, 3);
    return surface;
}

TEST(Camera, GoesAroundAtTheLeastDistanceThatShowsAllFromEverySide) {
    const Box box{{-3, 1, -2}, {5, 2, 0.5}};
    const Surface surface = slanting_surface();
    for (const Projection projection : {Projection::perspective, Projection::parallel}) {
        for (const View view : all_views) {
            for (const double aspect : {0.5, 1.0, 2.0}) {
                for (const double elevation : {-40.0, 0.0, 15.0}) {
                    Camera first = camera_of(view, projection);
                    first.orbit(0, elevation);
                    first.fit_orbit(box, aspect, 0.05);
                    double farthest = 0;
                    for (int azimuth = 0; azimuth < 360; ++azimuth) {
                        Camera camera = camera_of(view, projection);
                        camera.orbit(azimuth, elevation);
                        camera.fit_orbit(box, aspect, 0.05);
                        EXPECT_NEAR(camera.distance, first.distance, 1e-9 * first.distance);
                        EXPECT_NEAR(camera.height, first.height, 1e-9 * first.height);
                        const Places places = places_of(camera, aspect, box);
                        farthest = std::max({farthest, -places.left, places.right, -places.lower, places.upper});
                    }
                    EXPECT_LE(farthest, 0.9 + 1e-9) << name_of(view) << elevation;
                    EXPECT_GE(farthest, 0.899) << name_of(view) << elevation;
                    Camera closer = camera_of(view, projection);
                    closer.orbit(0, elevation);
                    closer.fit_orbit(surface, aspect, 0.05);
                    EXPECT_LE(closer.distance, first.distance * (1 + 1e-9)) << "a surface may be smaller than its box";
                    EXPECT_LE(closer.height, first.height * (1 + 1e-9));
                }
            }
        }
    }
    Camera camera;
    camera.fit_orbit(Box{}, 1);
    EXPECT_GT(camera.distance, 0);
}

} // namespace
} // namespace isotet::test
