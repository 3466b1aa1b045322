// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Each defect is counted, located, and blamed only where the rule says so.
#include <gtest/gtest.h>

#include "check/made_surface.hpp"

namespace {

using namespace isotet;
using namespace isotet::test;

TEST(CheckDefects, FindsTheRimOfAnOpenBox) {
    Soup soup = octahedron();
    soup.triangles.pop_back();
    const SurfaceReport open = check_of(soup);
    EXPECT_EQ(open.boundary_edges, 3u);
    EXPECT_EQ(open.inconsistent_edges, 0u);
    EXPECT_EQ(open.blamed_edges, 0u);
    EXPECT_FALSE(open.closed);
    EXPECT_TRUE(open.sound);
    EXPECT_TRUE(open.genus.empty());
    EXPECT_TRUE(has_finding(open, "edge 0-3 is used 0 times forward, 1 backward"));

    const SurfaceReport blamed = check_of(soup, {.closed = true});
    EXPECT_EQ(blamed.blamed_edges, 3u);
    EXPECT_FALSE(blamed.sound);
    EXPECT_FALSE(blamed.clean);
}

TEST(CheckDefects, FindsTheThreeEdgesOfAFlippedTriangle) {
    Soup soup = octahedron();
    std::swap(soup.triangles[0][0], soup.triangles[0][1]);
    const SurfaceReport report = check_of(soup, {.closed = true});
    EXPECT_EQ(report.boundary_edges, 0u);
    EXPECT_EQ(report.inconsistent_edges, 3u);
    EXPECT_EQ(report.blamed_edges, 3u);
    EXPECT_EQ(report.non_manifold_edges, 0u);
    EXPECT_EQ(report.touching_vertices, 0u);
    EXPECT_TRUE(report.genus.empty()); // not oriented
    EXPECT_FALSE(report.closed);
    EXPECT_FALSE(report.sound);
}

TEST(CheckDefects, FindsADoubleSheetAndBlamesItOnlyWhenStrict) {
    const SurfaceReport report =
        check_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}}}, {.closed = true});
    EXPECT_EQ(report.double_sheets, 1u);
    EXPECT_EQ(report.duplicate_triangles, 0u);
    EXPECT_TRUE(report.sound);
    EXPECT_FALSE(report.clean);
    EXPECT_TRUE(has_finding(report, "triangles 0 and 1 lie on the same corners"));
}

TEST(CheckDefects, BlamesARepeatedTriangleInTheSameDirection) {
    Soup soup = octahedron();
    soup.triangles.push_back({4, 0, 2}); // the first one, turned
    const SurfaceReport report = check_of(soup);
    EXPECT_EQ(report.duplicate_triangles, 1u);
    EXPECT_EQ(report.blamed_duplicates, 1u);
    EXPECT_EQ(report.inconsistent_edges, 3u);
    EXPECT_EQ(report.non_manifold_edges, 3u);
    EXPECT_FALSE(report.sound);
    EXPECT_TRUE(has_finding(report, "triangle 8 repeats triangle 0"));
}

TEST(CheckDefects, PairsRepeatedTrianglesOfBothDirections) {
    const SurfaceReport report =
        check_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {1, 0, 2}, {1, 2, 0}, {0, 2, 1}, {2, 0, 1}}});
    EXPECT_EQ(report.double_sheets, 2u);
    EXPECT_EQ(report.duplicate_triangles, 3u);
}

TEST(CheckDefects, FindsAVertexWhereTwoSheetsTouch) {
    Soup soup = octahedron();
    for (const auto& t : octahedron().triangles) {
        // A second octahedron on its tip: its vertex 5 is the first one's vertex 4.
        const auto number = [](std::uint32_t v) { return v == 5 ? 4 : v + 6; };
        soup.triangles.push_back({number(t[0]), number(t[1]), number(t[2])});
    }
    for (std::size_t i = 0; i < 5; ++i) {
        auto v = octahedron().vertices[i];
        v[2] += 2;
        soup.vertices.push_back(v);
    }
    const SurfaceReport report = check_of(soup, {.closed = true});
    EXPECT_EQ(report.touching_vertices, 1u);
    EXPECT_EQ(report.components, 1u);
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.genus.empty()); // not a manifold
    EXPECT_TRUE(report.sound);
    EXPECT_FALSE(report.clean);
    EXPECT_TRUE(has_finding(report, "the triangles around vertex 4 are not one fan"));
}

TEST(CheckDefects, FindsABowTie) {
    const SurfaceReport report =
        check_of({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}});
    EXPECT_EQ(report.touching_vertices, 1u);
    EXPECT_EQ(report.boundary_edges, 6u);
}

TEST(CheckDefects, FindsAnEdgeWithFourTriangles) {
    // Two tetrahedra that share the edge 0-1.
    Soup soup{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {}};
    for (const auto& [c, d] : {std::pair{2u, 3u}, std::pair{4u, 5u}}) {
        soup.triangles.push_back({0, 1, c});
        soup.triangles.push_back({1, 0, d});
        soup.triangles.push_back({1, d, c});
        soup.triangles.push_back({0, c, d});
    }
    const SurfaceReport report = check_of(soup, {.closed = true});
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.sound);
    EXPECT_EQ(report.non_manifold_edges, 1u);
    EXPECT_EQ(report.touching_vertices, 2u);
    EXPECT_TRUE(report.genus.empty());
    EXPECT_FALSE(report.clean);
}

TEST(CheckDefects, FindsVerticesAtOnePlace) {
    Soup soup = octahedron();
    soup.add(octahedron().moved(2, 0, 0));  // the tip at (1, 0, 0) is there twice
    soup.vertices.push_back({-0.0f, 0, 1}); // and (0, 0, 1), with a minus
    const SurfaceReport report = check_of(soup);
    EXPECT_EQ(report.coincident_vertices, 2u);
    EXPECT_TRUE(report.sound);
    EXPECT_FALSE(report.clean);
    EXPECT_TRUE(has_finding(report, "vertex 7 is at the place of vertex 0"));
}

TEST(CheckDefects, BlamesTrianglesWithEqualCorners) {
    Soup soup = octahedron();
    soup.triangles.push_back({0, 2, 0});
    soup.triangles.push_back({1, 1, 1});
    const SurfaceReport report = check_of(soup, {.closed = true});
    EXPECT_EQ(report.equal_corner_triangles, 2u);
    EXPECT_EQ(report.zero_area_triangles, 0u);
    EXPECT_EQ(report.euler, 2); // they are no part of the surface
    EXPECT_TRUE(report.closed);
    EXPECT_FALSE(report.sound);
    EXPECT_TRUE(has_finding(report, "triangle 8 (0, 2, 0) has equal corners"));
}

TEST(CheckDefects, TellsZeroAreaFromNearlyZeroExactly) {
    // One third, rounded, is not on the line from (0, 0) to (1, 3) by 2^-26; 0.5 is on it.
    const float third = 1.0f / 3;
    Soup on{{{0, 0, 0}, {0.5f, 1.5f, 0}, {1, 3, 0}}, {{0, 1, 2}}};
    Soup off{{{0, 0, 0}, {third, 1, 0}, {1, 3, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(check_of(on).zero_area_triangles, 1u);
    EXPECT_FALSE(check_of(on).clean);
    EXPECT_TRUE(check_of(on).sound);
    EXPECT_TRUE(has_finding(check_of(on), "triangle 0 (0, 1, 2) has no area"));
    EXPECT_EQ(check_of(off).zero_area_triangles, 0u);
    // Far from the origin and tiny beside the coordinates.
    Soup far{{{4e6f, 4e6f, 0}, {4e6f, 4e6f, 1e-30f}, {4e6f, 4000000.25f, 0}}, {{0, 1, 2}}};
    EXPECT_EQ(check_of(far).zero_area_triangles, 0u);
    far.vertices[2] = {4e6f, 4e6f, 3e-38f};
    EXPECT_EQ(check_of(far).zero_area_triangles, 1u);
}

TEST(CheckDefects, ListsAsManyFindingsOfAKindAsAskedForTheSameEachTime) {
    Soup soup;
    for (int i = 0; i < 3000; ++i) soup.add(square().moved(static_cast<float>(2 * i), 0, 0));
    CheckOptions options;
    options.max_findings = 3;
    const SurfaceReport report = check_of(soup, options);
    EXPECT_EQ(report.boundary_edges, 12000u);
    ASSERT_EQ(report.findings.size(), 3u);
    EXPECT_EQ(report.findings[0].what, "edge 0-1 is used 1 time forward, 0 backward");
    EXPECT_EQ(report.findings[0].where, (std::array<double, 3>{0.5, 0, 0}));
    EXPECT_EQ(report.findings[2].what, "edge 1-2 is used 1 time forward, 0 backward");
    options.max_findings = -1;
    EXPECT_TRUE(check_of(soup, options).findings.empty());
}

TEST(CheckDefects, WeldsUnconnectedTrianglesByTheirExactPlaces) {
    Soup soup;
    const Soup whole = octahedron();
    for (const auto& t : whole.triangles)
        soup.add({{whole.vertices[t[0]], whole.vertices[t[1]], whole.vertices[t[2]]}, {{0, 1, 2}}});
    soup.vertices[1][0] = -0.0f;
    soup.add({{{1, 0, 0}, {0, 1, 0}, {1, 0, 0}}, {{0, 1, 2}}}); // collapses
    const SurfaceReport apart = check_of(soup);
    EXPECT_EQ(apart.components, 9u);
    EXPECT_EQ(apart.boundary_edges, 27u);

    const SurfaceReport report = check_of(soup, {.closed = true, .weld = true});
    EXPECT_EQ(report.vertices, 6u);
    EXPECT_EQ(report.triangles, 8u);
    EXPECT_EQ(report.collapsed_by_welding, 1u);
    EXPECT_EQ(report.coincident_vertices, 0u);
    EXPECT_EQ(report.euler, 2);
    EXPECT_TRUE(report.clean);
}

} // namespace
