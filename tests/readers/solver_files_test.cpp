// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files of solvers that refine locally: surfaces are closed across their levels.
#include <numbers>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/boundary.hpp>
#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>
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

TEST(SolverFiles, RefinedCubesOfMfemAreClosed) {
    struct Case {
        const char* file;
        std::uint64_t points, cells;
    };
    for (const auto& [file, points, cells] :
         {Case{"vtu/mfem_levels_hex.vtu", 179, 41}, Case{"vtu/mfem_levels_wedge.vtu", 104, 38},
          Case{"vtk/mfem_levels_tet.vtk", 116, 96}}) {
        SCOPED_TRACE(file);
        const Grid grid = read((source_folder() / "data" / file).string()).value().grid;
        const ClosedGrid closed = close_hanging_points(merge_points(grid, {.tolerance = 0})->grid).value();
        EXPECT_EQ(closed.report.points, points);
        EXPECT_EQ(closed.report.cells, cells);
        EXPECT_EQ(closed.report.levels, 2u);
        EXPECT_EQ(closed.report.open_faces + closed.report.near_faces, 0u);
        const SurfaceReport boundary = check(boundary_of(closed.grid).value()).value();
        EXPECT_TRUE(boundary.closed);
        EXPECT_NEAR(boundary.volume, 1, 1e-6);
        EXPECT_NEAR(boundary.area, 6, 1e-5) << "no face inside is left";
        const PointField field = find_field(closed.grid, "distance").value();
        EXPECT_LT(closed.largest_difference(field.values).value(), 1e-6) << "MFEM constrains hanging points";
        ContourOptions options;
        options.edge_ends = true;
        auto session = Contour::create({closed.grid, field, {}, {}}, options).value();
        for (const double radius : {0.3, 0.55, 0.6, 1.1}) {
            const Surface surface = session.extract(radius)->surfaces[0].surface;
            const SurfaceReport report = check(surface, {.grid = &closed.grid, .field = &field}).value();
            EXPECT_TRUE(report.clean) << radius;
            EXPECT_EQ(report.hanging_edges, 0u) << radius;
            if (radius < 0.5 || radius > 1) continue; // levels are at the other two
            EXPECT_NEAR(report.area / (std::numbers::pi * radius * radius / 2), 1, 0.03) << radius;
        }
    }
}

} // namespace
} // namespace isotet::test
