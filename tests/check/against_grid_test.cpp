// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// With a grid, an open edge is blamed unless its grid points lie in one boundary face of the valid tets.
#include <limits>

#include <gtest/gtest.h>

#include "check/made_surface.hpp"

namespace {

using namespace isotet;
using namespace isotet::test;

using Tets = std::vector<std::array<std::int32_t, 4>>;
using Ends = std::vector<std::array<std::int64_t, 2>>;

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

/// Points 0 to 3 are the corners of an upright tet, 4 lies beyond its face 0 1 3, 5 within the plane of that face, 6
/// behind point 2.
Grid grid_of(const Tets& tets) {
    std::vector<float> points{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 2, 0, 2, 0, 2, 0};
    std::vector<std::int32_t> connectivity;
    for (const auto& tet : tets) connectivity.insert(connectivity.end(), tet.begin(), tet.end());
    Grid grid;
    grid.points = Array::own(std::move(points), 3);
    grid.cells.connectivity = Array::own(std::move(connectivity));
    return grid;
}

PointField field_of(std::vector<float> values) {
    PointField field;
    field.name = "f";
    field.values = Array::own(std::move(values));
    return field;
}

/// One triangle whose vertices lie between these grid points.
Surface triangle_on(const Ends& ends, int copies = 1) {
    Soup soup{{{0, 0, 0.5f}, {0.5f, 0, 0.5f}, {0, 0.5f, 0.5f}}, {}};
    for (int i = 0; i < copies; ++i) soup.triangles.push_back({0, 1, 2});
    Surface surface = surface_of(soup);
    std::vector<std::int64_t> flat;
    for (const auto& pair : ends) flat.insert(flat.end(), pair.begin(), pair.end());
    surface.edge_ends = Array::own(std::move(flat), 2);
    return surface;
}

SurfaceReport against(const Grid& grid, const Surface& surface, const PointField* field = nullptr,
                      bool split_cells = false) {
    return check(surface, {.grid = &grid, .field = field, .split_cells = split_cells}).value();
}

// The triangle that cuts point 3 off the tet 0 1 2 3: its three edges lie in the faces 0 1 3, 1 2 3 and 0 2 3.
const Ends around_3{{0, 3}, {1, 3}, {2, 3}};
const std::array<std::int32_t, 4> tet{0, 1, 2, 3}, neighbour{0, 3, 1, 4};

TEST(CheckAgainstGrid, BlamesNothingOnTheBoundaryOfTheGrid) {
    const SurfaceReport report = against(grid_of({tet}), triangle_on(around_3));
    EXPECT_EQ(report.boundary_edges, 3u);
    EXPECT_EQ(report.blamed_edges, 0u);
    EXPECT_TRUE(report.sound);
}

TEST(CheckAgainstGrid, BlamesTheEdgeThatShouldGoOnInTheNextTet) {
    const SurfaceReport report = against(grid_of({tet, neighbour}), triangle_on(around_3));
    EXPECT_EQ(report.blamed_edges, 1u);
    EXPECT_FALSE(report.sound);
    EXPECT_TRUE(has_finding(report, "edge 0-1 is used 1 time forward, 0 backward"));
}

TEST(CheckAgainstGrid, BlamesNothingBesideATetWithoutData) {
    const Grid grid = grid_of({tet, neighbour});
    const PointField field = field_of({0, 0, 0, 1, nan_value, 0, 0});
    EXPECT_EQ(against(grid, triangle_on(around_3), &field).blamed_edges, 0u);
}

TEST(CheckAgainstGrid, BlamesAnEdgeThroughTheInsideOfATet) {
    const SurfaceReport report = against(grid_of({tet}), triangle_on({{0, 3}, {1, 2}, {1, 3}}));
    EXPECT_EQ(report.blamed_edges, 1u); // 0-1 has four grid points; 1-2 and 2-0 lie in faces
}

TEST(CheckAgainstGrid, BlamesAnEdgeBetweenPointsThatShareNoFace) {
    EXPECT_EQ(against(grid_of({tet, neighbour}), triangle_on({{2, 2}, {4, 4}, {0, 0}})).blamed_edges, 1u);
}

TEST(CheckAgainstGrid, AcceptsEdgesBetweenTiedPointsOnTheBoundary) {
    EXPECT_EQ(against(grid_of({tet}), triangle_on({{0, 0}, {1, 1}, {2, 2}})).blamed_edges, 0u);
    EXPECT_EQ(against(grid_of({tet}), triangle_on({{0, 0}, {1, 2}, {2, 2}})).blamed_edges, 0u);
}

TEST(CheckAgainstGrid, CountsATetThatIsThereTwiceOnce) {
    EXPECT_EQ(against(grid_of({tet, {1, 2, 0, 3}}), triangle_on(around_3)).blamed_edges, 0u);
    EXPECT_EQ(against(grid_of({tet, neighbour, tet}), triangle_on(around_3)).blamed_edges, 1u);
}

TEST(CheckAgainstGrid, LooksAtTetsUprightWhateverTheirOrderInTheFile) {
    EXPECT_EQ(against(grid_of({tet, {0, 1, 3, 4}}), triangle_on(around_3)).blamed_edges, 1u);
    EXPECT_EQ(against(grid_of({{0, 2, 1, 3}, neighbour}), triangle_on(around_3)).blamed_edges, 1u);
}

TEST(CheckAgainstGrid, AcceptsEdgesInAFaceBetweenOverlappingTets) {
    // Tets 0 1 2 3 and 0 1 6 3 lie on the same side of the face 0 1 3.
    const Grid grid = grid_of({tet, {0, 1, 6, 3}});
    EXPECT_EQ(against(grid, triangle_on(around_3)).blamed_edges, 0u);
}

TEST(CheckAgainstGrid, MirrorsAFlatTetWhenMostTetsAre) {
    // The flat tet 0 1 3 5 continues the upright one when both stand alike in the file.
    EXPECT_EQ(against(grid_of({tet, {0, 1, 3, 5}}), triangle_on(around_3)).blamed_edges, 1u);
    EXPECT_EQ(against(grid_of({{0, 2, 1, 3}, {0, 3, 1, 5}}), triangle_on(around_3)).blamed_edges, 1u);
    EXPECT_EQ(against(grid_of({{0, 2, 1, 3}, {0, 1, 3, 5}}), triangle_on(around_3)).blamed_edges, 0u);
}

TEST(CheckAgainstGrid, ExplainsRepeatedTrianglesByTwoTetsOnOneSide) {
    const Surface twice = triangle_on({{0, 0}, {1, 1}, {3, 3}}, 2);
    const SurfaceReport explained = against(grid_of({tet, {0, 1, 6, 3}}), twice);
    EXPECT_EQ(explained.duplicate_triangles, 1u);
    EXPECT_EQ(explained.blamed_duplicates, 0u);
    EXPECT_TRUE(explained.sound);
    EXPECT_EQ(against(grid_of({tet, neighbour}), twice).blamed_duplicates, 1u);
    EXPECT_EQ(check(twice).value().blamed_duplicates, 1u);
}

TEST(CheckAgainstGrid, BlamesAllOpenEdgesWhenAskedForAClosedSurfaceToo) {
    const Grid grid = grid_of({tet});
    EXPECT_EQ(check(triangle_on(around_3), {.closed = true, .grid = &grid}).value().blamed_edges, 3u);
}

TEST(CheckAgainstGrid, SplitsOtherCellsAsExtractionDoes) {
    // The diagonal of each quad starts at its lowest corner: 1-6, not 2-5; 0-6 runs through the inside.
    Grid grid;
    grid.points =
        Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1}, 3);
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, 3, 4, 5, 6, 7});
    grid.cells.uniform_type = CellType::hexahedron;
    const auto blamed = [&](std::int64_t a, std::int64_t b, bool split_cells) {
        return against(grid, triangle_on({{a, a}, {b, b}, {1, 1}}), nullptr, split_cells).blamed_edges;
    };
    EXPECT_EQ(blamed(0, 2, true), 0u);
    EXPECT_EQ(blamed(2, 6, true), 0u);
    EXPECT_EQ(blamed(2, 5, true), 1u);
    EXPECT_EQ(blamed(0, 6, true), 1u);
    EXPECT_EQ(blamed(2, 5, false), 0u); // a face as a whole
    EXPECT_EQ(blamed(0, 6, false), 1u);
}

TEST(CheckAgainstGrid, NamesAnEdgeEndThatTheGridDoesNotHave) {
    const Grid grid = grid_of({tet});
    for (const std::int64_t wrong : {std::int64_t{7}, std::int64_t{-1}, std::numeric_limits<std::int64_t>::min()}) {
        const auto report = check(triangle_on({{0, 3}, {wrong, 3}, {2, 3}}), {.grid = &grid});
        ASSERT_FALSE(report);
        EXPECT_EQ(report.error().code, ErrorCode::invalid_data);
        EXPECT_EQ(report.error().message,
                  "vertex 1 lies on an edge of point " + std::to_string(wrong) +
                      ", but the grid has 7 points: it is not the grid from which the surface was extracted");
    }
}

TEST(CheckAgainstGrid, RefusesAFieldThatDoesNotFit) {
    const Grid grid = grid_of({tet});
    const PointField field = field_of({1, 2, 3});
    const auto report = check(triangle_on(around_3), {.grid = &grid, .field = &field});
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::invalid_argument);
}

TEST(CheckAgainstGrid, RefusesABrokenGrid) {
    const Grid grid = grid_of({{0, 1, 2, 9}});
    const auto report = check(triangle_on(around_3), {.grid = &grid});
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::invalid_data);
}

} // namespace
