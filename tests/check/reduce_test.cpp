// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/surface.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/solid.hpp>

#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

/// The part of a cube of side 2 outside of a ball: flat faces with round openings, and the ball.
Surface holed_cube(const Run& run = {}) {
    ContourInput input;
    input.grid = made_grid("kuhn", 16, {"sphere"});
    input.field = {"sphere", input.grid.point_fields.at(0).values, false, {}};
    input.point_fields = input.grid.point_fields;
    Solids solids = Solids::create(std::move(input), {}, run).value();
    return solids.extract(SolidRange::above(1.1), run).value().surface;
}

bool closes(const Surface& surface) { return check(surface, {.closed = true}).value().closed; }

double enclosed(const Surface& surface) {
    double volume = 0;
    for (const SurfacePart& part : find_parts(surface).value().parts) volume += part.volume;
    return volume;
}

TEST(Reduce, KeepsSolidsClosedAndTheirVolume) {
    const Surface surface = holed_cube();
    ASSERT_TRUE(closes(surface));
    const ReducedSurface reduced = reduce(surface, {.share = 0.8}).value();
    EXPECT_EQ(reduced.triangles_before, surface.triangle_count());
    EXPECT_LT(reduced.surface.triangle_count(), surface.triangle_count() / 3);
    const SurfaceReport report = check(reduced.surface, {.closed = true}).value();
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.double_sheets, 0u);
    EXPECT_NEAR(enclosed(reduced.surface), enclosed(surface), 0.01 * enclosed(surface));
    EXPECT_NEAR(area(reduced.surface), area(surface), 0.02 * area(surface));
    EXPECT_GT(reduced.error, 0);
}

/// Where flat faces could lose more than that without an error.
TEST(Reduce, LeavesSurfacesOfFewTrianglesAsTheyAre) {
    for (std::uint32_t count = 1; count <= 4; ++count) {
        Surface surface;
        std::vector<float> positions;
        std::vector<std::uint32_t> triangles;
        for (std::uint32_t i = 0; i < count; ++i) {
            for (const float x : {0.F, 1.F, 0.F})
                positions.insert(positions.end(), {x, static_cast<float>(i), x * x - x + 1});
            positions[positions.size() - 1] += 1;
            for (std::uint32_t k = 0; k < 3; ++k) triangles.push_back(3 * i + k);
        }
        surface.positions = Array::own(std::move(positions), 3);
        surface.triangles = Array::own(std::move(triangles), 3);
        EXPECT_EQ(reduce(surface, {.share = 0.9}).value().surface.triangle_count(), count);
    }
}

TEST(Reduce, LeavesOutNoMoreThanTheShare) {
    ContourInput input;
    input.grid = made_grid("kuhn", 12, {"sphere"});
    input.field = {"sphere", input.grid.point_fields.at(0).values, false, {}};
    Solids solids = Solids::create(std::move(input)).value();
    const Surface surface = solids.extract(SolidRange::above(0.3)).value().surface;
    for (const double share : {0.1, 0.3, 0.5}) {
        const auto left = static_cast<double>(reduce(surface, {.share = share}).value().surface.triangle_count());
        EXPECT_NEAR(left / static_cast<double>(surface.triangle_count()), 1 - share, 0.03) << share;
    }
}

/// Parts are reduced to one error: beside a flat face with many triangles the isosurface keeps its own.
TEST(Reduce, MovesAllPartsOfASurfaceAlike) {
    const Surface surface = holed_cube();
    double last = 0;
    for (const double share : {0.3, 0.5, 0.7, 0.85}) {
        const ReducedSurface both = reduce(surface, {.share = share}).value();
        EXPECT_GE(both.error, last);
        last = both.error;
        const auto left = static_cast<double>(both.surface.triangle_count());
        EXPECT_NEAR(left / static_cast<double>(surface.triangle_count()), 1 - share, 0.05) << share;
        // With this error as the only limit the same triangles go, about.
        const ReducedSurface by_error = reduce(surface, {.share = 0.999, .error = 1.05 * both.error}).value();
        EXPECT_LT(static_cast<double>(by_error.surface.triangle_count()), 1.15 * left) << share;
        EXPECT_GT(static_cast<double>(by_error.surface.triangle_count()), 0.7 * left) << share;
    }
}

TEST(Reduce, TakesFlatFacesWithoutAnError) {
    const Surface surface = holed_cube();
    const ReducedSurface reduced = reduce(surface, {.share = 0.99, .error = 1e-6}).value();
    EXPECT_LT(reduced.surface.triangle_count(), surface.triangle_count());
    EXPECT_LE(reduced.error, 1e-6);
    EXPECT_TRUE(closes(reduced.surface));
    EXPECT_NEAR(enclosed(reduced.surface), enclosed(surface), 1e-3);
}

TEST(Reduce, KeepsVerticesWithTheirFieldsAndTellsWhatGoes) {
    Surface surface = holed_cube();
    surface.cell_fields.push_back({"region", Array::own(std::vector<std::int32_t>(surface.triangle_count()))});
    const ReducedSurface reduced = reduce(surface).value();
    EXPECT_EQ(reduced.left_out, std::vector<std::string>{"region"});
    ASSERT_EQ(reduced.surface.point_fields.size(), 1u);
    ASSERT_EQ(reduced.surface.cell_fields.size(), 1u);
    EXPECT_EQ(reduced.surface.cell_fields[0].name, "boundary");
    const Field& field = reduced.surface.point_fields[0];
    for (std::size_t i = 0; i < reduced.surface.vertex_count(); ++i) {
        const auto x = [&](std::size_t axis) { return reduced.surface.positions.at(i, axis); };
        EXPECT_NEAR(field.values.at(i), std::hypot(x(0), x(1), x(2)), 0.02);
    }
    for (std::size_t i = 0; i < reduced.surface.triangle_count(); ++i) {
        if (reduced.surface.cell_fields[0].values.at(i) != 0) continue;
        const auto vertex = static_cast<std::size_t>(reduced.surface.triangles.at(i, 0));
        EXPECT_NEAR(field.values.at(vertex), 1.1, 1e-6) << "of the isosurface";
    }
}

TEST(Reduce, WorksOutNormalsAnew) {
    Surface surface = holed_cube();
    surface.normals_kind = Normals::vertex;
    surface.normals = vertex_normals(surface).value();
    const Surface reduced = reduce(surface).value().surface;
    EXPECT_EQ(reduced.normals_kind, Normals::vertex);
    EXPECT_EQ(reduced.normals.tuples(), reduced.vertex_count());
}

TEST(Reduce, IsTheSameOnAnyNumberOfThreads) {
    const Surface surface = holed_cube();
    EXPECT_EQ(bytes_of(reduce(surface, {}, {.threads = 1}).value().surface),
              bytes_of(reduce(surface, {}, {.threads = 7}).value().surface));
}

/// However much may go, a closed surface does not vanish.
TEST(Reduce, LeavesSomethingOfAClosedSurface) {
    const Grid grid = made_grid("kuhn", 16, {"sphere"});
    const Surface surface = contour(grid.points, grid.cells, grid.point_fields.at(0).values, 0.3).value();
    const ReduceOptions nearly_all{.share = 0.9999}, any_error{.share = 0.9999, .error = 100};
    for (const ReduceOptions& options : {nearly_all, any_error}) {
        const ReducedSurface reduced = reduce(surface, options).value();
        EXPECT_GE(reduced.surface.triangle_count(), 4u);
        EXPECT_LT(reduced.surface.triangle_count(), 20u);
        EXPECT_TRUE(closes(reduced.surface));
    }
}

TEST(Reduce, OfNothingIsNothing) {
    const ReducedSurface reduced = reduce(Surface{}).value();
    EXPECT_EQ(reduced.surface.triangle_count(), 0u);
    EXPECT_EQ(reduced.error, 0);
}

TEST(Reduce, RefusesSharesAndErrorsThatAreNone) {
    const Surface surface = holed_cube();
    for (const ReduceOptions& wrong : {ReduceOptions{1}, ReduceOptions{-0.1}, ReduceOptions{std::nan("")},
                                       ReduceOptions{0.5, -1}, ReduceOptions{0.5, std::nan("")}}) {
        const auto result = reduce(surface, wrong);
        ASSERT_FALSE(result);
        EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
    }
    Surface broken = surface;
    broken.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 4000000}, 3);
    broken.cell_fields.clear();
    EXPECT_EQ(reduce(broken).error().code, ErrorCode::invalid_data);
}

} // namespace
} // namespace isotet::test
