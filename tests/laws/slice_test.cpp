// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Slices have the areas of the shapes that they cut along.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/slice.hpp>

#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

Surface slice_along(const Grid& grid, const SliceShape& shape, std::optional<Method> method = {}) {
    ContourOptions options;
    options.method = method;
    options.surfaces = 1;
    options.expected_isovalues = {slice_isovalue(shape)};
    ContourInput input{grid, slice_field(grid.points, shape).value(), {}, {}};
    Contour session = Contour::create(std::move(input), options).value();
    return std::move(session.extract(slice_isovalue(shape)).value().surfaces.front().surface);
}

double height(const Surface& surface, std::size_t vertex, const Plane& plane) {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) sum += plane.normal[axis] * surface.positions.at(vertex, axis);
    return sum;
}

TEST(SliceAlongAPlane, HasTheAreaOfTheCutCubeAndIsFlat) {
    const std::pair<Plane, double> cuts[] = {
        {{{0, 0, 1}, 0.3}, 4},                          // a square
        {{{-1, 0, 0}, 0.25}, 4},                        // another one
        {{{1, 1, 1}, 0}, 3 * std::sqrt(3.0)},           // a regular hexagon
        {{{2, 2, 0}, 0}, 4 * std::sqrt(2.0)},           // through two edges
        {{{1, 1, 1}, 2}, std::sqrt(3.0) / 2},           // a triangle
        {{{1e-3, 2e-3, 0}, 1e-4}, 2 * std::sqrt(5.0)}}; // a short normal
    for (const char* shape : {"kuhn", "layer", "mixed", "tet10", "kelvin"}) {
        const Grid grid = made_grid(shape, 4, {"sphere"});
        for (const auto& [plane, area_there] : cuts)
            for (const Method method : {Method::direct, Method::clusters}) {
                SCOPED_TRACE(testing::Message() << shape << " " << area_there << " " << name_of(method));
                const Surface slice = slice_along(grid, plane, method);
                const bool fills_the_cube = shape != std::string("kelvin");
                EXPECT_NEAR(area(slice), area_there, (fills_the_cube ? 1e-5 : 1) * area_there);
                EXPECT_GT(slice.triangle_count(), 0u);
                const auto& n = plane.normal;
                const double near = 1e-6 * (std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]));
                for (std::size_t i = 0; i < slice.vertex_count(); ++i)
                    ASSERT_NEAR(height(slice, i, plane), plane.offset, near);
            }
    }
}

TEST(SliceAlongAPlane, ThroughPointsIsCutOnce) {
    for (const char* shape : {"kuhn", "hex", "wedge", "pyramid"})
        for (const double z : {-0.5, 0.0, 0.5})
            EXPECT_NEAR(area(slice_along(made_grid(shape, 8, {"sphere"}), Plane{{0, 0, 1}, z})), 4, 1e-6) << shape << z;
}

TEST(SliceAlongAPlane, FacesAlongTheNormal) {
    const Surface up = slice_along(made_grid("kuhn", 3, {"sphere"}), Plane{{0, 0, 2}, 0.1});
    const Surface down = slice_along(made_grid("kuhn", 3, {"sphere"}), Plane{{0, 0, -1}, 0.1});
    const auto turn = [](const Surface& surface) {
        double sum = 0;
        for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
            const auto corner = [&](std::size_t k, std::size_t axis) {
                return surface.positions.at(static_cast<std::size_t>(surface.triangles.at(t, k)), axis);
            };
            sum += (corner(1, 0) - corner(0, 0)) * (corner(2, 1) - corner(0, 1)) -
                   (corner(1, 1) - corner(0, 1)) * (corner(2, 0) - corner(0, 0));
        }
        return sum / 2;
    };
    EXPECT_NEAR(turn(up), 4, 1e-6);
    EXPECT_NEAR(turn(down), -4, 1e-6);
}

TEST(SliceAlongASphere, IsClosedAndItsAreaConvergesQuadratically) {
    const double exact = 4 * std::numbers::pi * 0.7 * 0.7;
    double before = exact;
    for (const std::uint64_t side : {8, 16, 32}) {
        const Surface slice = slice_along(made_grid("perturbed", side, {"plane"}), Sphere{{0.05, -0.1, 0.2}, 0.7});
        const SurfaceReport report = check(slice).value();
        EXPECT_TRUE(report.closed);
        EXPECT_EQ(report.euler, 2);
        EXPECT_GT(report.volume, 0) << "it faces outwards";
        const double off = std::abs(report.area - exact);
        EXPECT_LT(off, before / 3) << side;
        before = off;
    }
    EXPECT_LT(before, 0.005 * exact);
}

TEST(SliceAlongACylinder, HasTheAreaOfTheMantle) {
    for (const double length : {1.0, 1e-30, 5e20}) {
        const Surface along_z =
            slice_along(made_grid("kuhn", 24, {"plane"}), Cylinder{{0, 0, length}, {0.1, 0.2, 7}, 0.5});
        EXPECT_NEAR(area(along_z), 2 * std::numbers::pi * 0.5 * 2, 0.05) << length;
    }
    const Cylinder tilted{{1, 1, 1}, {0.25, 0.25, 0.25}, 0.4};
    const PointField field = slice_field(Array::own(std::vector<double>{1, 1, 1, 1, 0, -1, 2, 3, 1}, 3), tilted).value();
    EXPECT_NEAR(field.values.at(0), 0, 1e-15);
    EXPECT_DOUBLE_EQ(field.values.at(1), std::sqrt(2.0));
    EXPECT_DOUBLE_EQ(field.values.at(2), std::sqrt(2.0));
}

TEST(SliceField, IsNamedAfterTheShape) {
    const Array points = Array::own(std::vector<float>{1, 2, 3}, 3);
    EXPECT_EQ(slice_field(points, Plane{{0, 0, 1}, 0}).value().name, "z");
    EXPECT_EQ(slice_field(points, Plane{{-1, 0, 0}, 0}).value().name, "-x");
    EXPECT_EQ(slice_field(points, Plane{{0, 2, 0}, 0}).value().name, "height along (0, 2, 0)");
    EXPECT_EQ(slice_field(points, Sphere{{0, 0.5, 1}, 2}).value().name, "distance from (0, 0.5, 1)");
    EXPECT_EQ(slice_field(points, Cylinder{{0, 0, 1}, {1, 2, 0}, 2}).value().name,
              "distance from the line along (0, 0, 1) through (1, 2, 0)");
    EXPECT_EQ(slice_field(points, Plane{{1, 10, 100}, 0}).value().values.at(0), 321);
    EXPECT_EQ(slice_field(points, Sphere{{1, -2, 0}, 0}).value().values.at(0), 5);
}

TEST(SliceField, RefusesWhatIsNoShape) {
    const Array points = Array::own(std::vector<float>{1, 2, 3}, 3);
    const double none = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
    const SliceShape wrong[] = {Plane{{0, 0, 0}, 1},          Plane{{none, 0, 1}, 1},     Plane{{0, 0, 1}, infinite},
                                Plane{{0, 1e200, 0}, 1},      Sphere{{0, 0, 0}, -1},      Sphere{{0, infinite, 0}, 1},
                                Cylinder{{0, 0, 0}, {}, 1},   Cylinder{{0, 0, 1}, {}, none},
                                Cylinder{{0, 0, 1}, {none}, 1}};
    for (const SliceShape& shape : wrong) {
        const auto field = slice_field(points, shape);
        ASSERT_FALSE(field);
        EXPECT_EQ(field.error().code, ErrorCode::invalid_argument) << field.error().message;
    }
    EXPECT_EQ(slice_field(points, Sphere{{0, 0, 0}, -1}).error().message,
              "the radius is -1, but must be finite and not negative");
    EXPECT_EQ(slice_field(Array::own(std::vector<float>{1, 2}, 2), Plane{}).error().code, ErrorCode::invalid_data);
    EXPECT_EQ(slice_field(Array::own(std::vector<int>{1, 2, 3}, 3), Plane{}).error().code, ErrorCode::invalid_data);
}

TEST(SliceField, IsTheSameBytesForAnyNumberOfThreads) {
    const Grid grid = made_grid("perturbed", 50, {"plane"});
    for (const SliceShape& shape : {SliceShape(Plane{{0.3, 0.7, -0.1}, 0}), SliceShape(Sphere{{0.1, 0.2, 0.3}, 1}),
                                    SliceShape(Cylinder{{0.3, 0.7, -0.1}, {0.1, 0.2, 0.3}, 1})}) {
        const PointField one = slice_field(grid.points, shape, {.threads = 1}).value();
        for (const int threads : {2, 7}) {
            const PointField out = slice_field(grid.points, shape, {.threads = threads}).value();
            EXPECT_TRUE(std::ranges::equal(out.values.as<double>(), one.values.as<double>()));
        }
    }
}

} // namespace
} // namespace isotet::test
