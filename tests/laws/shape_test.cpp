// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces of analytic fields have the topology, area, volume and normals that mathematics says.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/small_grid.hpp"
#include "support/surface_sets.hpp"

namespace isotet::test {
namespace {

using std::numbers::pi;

/// A shape and a number of cubes along its side.
class OnEveryShape : public testing::TestWithParam<std::tuple<const char*, int>> {
protected:
    Grid grid(std::string field) const {
        const auto [shape, side] = GetParam();
        return made_grid(shape, static_cast<std::uint64_t>(side), {std::move(field)});
    }
    PackedGrid packed(const Grid& grid) const {
        PackOptions options;
        options.gradients = true;
        return pack(grid, point_field(grid), options).value();
    }
};

INSTANTIATE_TEST_SUITE_P(
    Laws, OnEveryShape,
    testing::Combine(testing::Values("kuhn", "perturbed", "shuffled", "hex", "wedge", "pyramid", "mixed"),
                     testing::Values(8, 13, 24)),
    [](const auto& made) { return std::get<0>(made.param) + std::to_string(std::get<1>(made.param)); });

TEST_P(OnEveryShape, SphereHasGenusZero) {
    const SurfaceReport report = check(extract(packed(grid("sphere")), 0.7).value().surface).value();
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.euler, 2);
    EXPECT_EQ(report.genus, std::vector<std::int64_t>{0});
    EXPECT_EQ(report.non_manifold_edges, 0u);
}

TEST_P(OnEveryShape, TorusHasGenusOne) {
    const SurfaceReport report = check(extract(packed(grid("torus")), 0.3).value().surface).value();
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.euler, 0);
    EXPECT_EQ(report.genus, std::vector<std::int64_t>{1});
}

TEST_P(OnEveryShape, VerticesLieOnTheirEdgesWhereTheFieldHasTheIsovalue) {
    const Grid g = grid("gyroid");
    ExtractOptions options;
    options.edge_ends = true;
    options.point_fields = {g.point_fields[0]};
    const Surface surface = extract(packed(g), 0.2, options).value().surface;
    ASSERT_GT(surface.vertex_count(), 0u);
    const auto values = g.point_fields[0].values.as<float>();
    for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
        const auto [below, above] = ends_of(surface, v);
        const auto low = static_cast<std::size_t>(below), high = static_cast<std::size_t>(above);
        ASSERT_LT(values[low], 0.2);
        ASSERT_GE(values[high], 0.2);
        const double t = surface.edge_weights.at(v);
        ASSERT_GE(t, 0);
        ASSERT_LE(t, 1);
        ASSERT_NEAR(values[low] + t * (values[high] - values[low]), 0.2, 1e-6);
        ASSERT_NEAR(surface.point_fields[0].values.at(v), 0.2, 1e-6);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double p0 = g.points.at(low, axis), p1 = g.points.at(high, axis);
            ASSERT_NEAR(surface.positions.at(v, axis), p0 + t * (p1 - p0), 2e-7);
        }
    }
}

TEST_P(OnEveryShape, TrianglesFaceHigherValues) {
    const Grid g = grid("sphere"); // higher values are outside
    ExtractOptions options;
    options.normals = Normals::face;
    const Surface surface = extract(packed(g), 0.6, options).value().surface;
    for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
        double outward = 0, geometric = 0;
        const auto c = corners_of(surface, t);
        const auto a = position_of(surface, c[0]), b = position_of(surface, c[1]), d = position_of(surface, c[2]);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
            outward += surface.normals.at(t, axis) * (a[axis] + b[axis] + d[axis]);
            geometric += ((b[j] - a[j]) * (d[k] - a[k]) - (b[k] - a[k]) * (d[j] - a[j])) * surface.normals.at(t, axis);
        }
        ASSERT_GT(outward, 0) << "triangle " << t;
        ASSERT_GT(geometric, 0) << "triangle " << t;
    }
}

TEST_P(OnEveryShape, NormalsHaveUnitLengthAndGradientNormalsPointAwayFromTheCentre) {
    const Grid g = grid("sphere");
    for (const Normals kind : {Normals::gradient, Normals::face, Normals::vertex}) {
        ExtractOptions options;
        options.normals = kind;
        const Surface surface = extract(packed(g), 0.6, options).value().surface;
        ASSERT_EQ(surface.normals.tuples(), kind == Normals::face ? surface.triangle_count() : surface.vertex_count());
        double worst = 1;
        for (std::size_t n = 0; n < surface.normals.tuples(); ++n) {
            const double x = surface.normals.at(n, 0), y = surface.normals.at(n, 1), z = surface.normals.at(n, 2);
            ASSERT_NEAR(x * x + y * y + z * z, 1, 1e-6);
            if (kind == Normals::face) continue;
            const auto p = position_of(surface, n);
            worst =
                std::min(worst, (x * p[0] + y * p[1] + z * p[2]) / std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]));
        }
        EXPECT_GT(worst, std::get<1>(GetParam()) > 20 ? 0.985 : 0.9);
    }
}

struct Measured {
    double area, volume;
};

Measured measure(const char* shape, int side, const char* field, double isovalue) {
    const Grid g = made_grid(shape, static_cast<std::uint64_t>(side), {field});
    const Surface surface = extract(pack(g, point_field(g)).value(), isovalue).value().surface;
    const SurfaceReport report = check(surface).value();
    EXPECT_NEAR(area(surface), report.area, 1e-9);
    return {report.area, report.volume};
}

/// The order at which errors fall from one side to a larger one.
double order_of(double coarse_error, double fine_error, double ratio) {
    return std::log(std::abs(coarse_error) / std::abs(fine_error)) / std::log(ratio);
}

void expect_second_order(const char* shape, const char* field, double isovalue, double exact_area, double exact_volume,
                         int side = 10) {
    const Measured coarse = measure(shape, side, field, isovalue), fine = measure(shape, 4 * side, field, isovalue);
    EXPECT_NEAR(order_of(coarse.area - exact_area, fine.area - exact_area, 4), 2, 0.4) << shape;
    EXPECT_NEAR(order_of(coarse.volume - exact_volume, fine.volume - exact_volume, 4), 2, 0.4) << shape;
}

TEST(Convergence, OfTheSphereIsOfSecondOrder) {
    constexpr double r = 0.7;
    for (const char* shape : {"kuhn", "perturbed", "hex", "wedge", "pyramid", "mixed"})
        expect_second_order(shape, "sphere", r, 4 * pi * r * r, 4 * pi * r * r * r / 3);
}

TEST(Convergence, OfTheTorusIsOfSecondOrder) {
    constexpr double r = 0.3, ring = 0.5;
    for (const char* shape : {"kuhn", "perturbed", "pyramid"})
        expect_second_order(shape, "torus", r, 4 * pi * pi * ring * r, 2 * pi * pi * ring * r * r, 16);
}

TEST(Plane, HasItsExactAreaAtEveryResolution) {
    // x + 2y + 3z = 0 cuts the cube [-1, 1]^3 in a parallelogram; over the (x, y) square its area is 4 sqrt(14) / 3,
    // where |x + 2y| <= 3 holds everywhere.
    for (const char* shape : {"kuhn", "shuffled", "layer", "hex", "wedge", "pyramid", "mixed"})
        for (const std::uint64_t side : {2u, 5u, 12u}) {
            const Grid g = made_grid(shape, side, {"plane"});
            EXPECT_NEAR(area(extract(pack(g, point_field(g)).value(), 0).value().surface), 4 * std::sqrt(14.0) / 3,
                        2e-6)
                << shape;
        }
}

TEST(Isovalues, OutsideTheRangeGiveAnEmptySurface) {
    const Grid g = made_grid("kuhn", 4, {"sphere"});
    PackOptions options;
    options.gradients = true;
    options.source_cells = true;
    const PackedGrid packed = pack(g, point_field(g), options).value();
    for (const double isovalue : {-1.0, 100.0, -1e300, 1e300}) {
        ExtractOptions everything;
        everything.normals = Normals::gradient;
        everything.edge_ends = everything.source_cells = true;
        everything.point_fields = g.point_fields;
        const Surface surface = extract(packed, isovalue, everything).value().surface;
        EXPECT_EQ(surface.vertex_count(), 0u);
        EXPECT_EQ(surface.triangle_count(), 0u);
        EXPECT_EQ(check(surface).value().triangles, 0u);
    }
}

} // namespace
} // namespace isotet::test
