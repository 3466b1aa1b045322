// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files of solvers that refine locally: surfaces are closed across their levels.
#include <numbers>

#include <gtest/gtest.h>

#include <isotet/boundary.hpp>
#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/hanging_points.hpp>
#include <isotet/read.hpp>

#include "support/places.hpp"

namespace isotet::test {
namespace {

TEST(SolverFiles, TheRefinedBallOfDealIiIsClosed) {
    const Grid file = read((source_folder() / "data/vtu/dealii_refined_ball.vtu").string()).value().grid;
    const ClosedGrid closed = close_hanging_points(merge_points(file, {.tolerance = 1e-6})->grid).value();
    EXPECT_EQ(closed.report.points, 202u);
    EXPECT_EQ(closed.report.cells, 86u);
    EXPECT_EQ(closed.report.open_faces, 0u);
    EXPECT_EQ(closed.report.near_faces, 20u) << "on the curved shape";
    EXPECT_TRUE(check(boundary_of(closed.grid).value())->closed);
    const PointField field = find_field(closed.grid, "radius").value();
    auto session = Contour::create({closed.grid, field, {}, {}}, {}).value();
    for (const double radius : {0.2, 0.35, 0.5, 0.7, 0.8, 0.9}) {
        const SurfaceReport report = check(session.extract(radius)->surfaces[0].surface).value();
        EXPECT_TRUE(report.closed) << radius;
        EXPECT_EQ(report.euler, 2) << radius;
        if (radius < 0.3) continue; // smaller than a cell
        EXPECT_NEAR(report.area / (4 * std::numbers::pi * radius * radius), 1, 0.15) << radius;
    }
}

} // namespace
} // namespace isotet::test
