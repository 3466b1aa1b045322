// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Components, Euler characteristic and genus of surfaces without defects.
#include <gtest/gtest.h>

#include "check/made_surface.hpp"

namespace {

using namespace isotet;
using namespace isotet::test;
using Genus = std::vector<std::int64_t>;

TEST(CheckTopology, CallsAnOctahedronClean) {
    const SurfaceReport report = check_of(octahedron(), {.closed = true});
    EXPECT_EQ(report.vertices, 6u);
    EXPECT_EQ(report.triangles, 8u);
    EXPECT_EQ(report.components, 1u);
    EXPECT_EQ(report.euler, 2);
    EXPECT_EQ(report.genus, Genus{0});
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.sound);
    EXPECT_TRUE(report.clean);
    EXPECT_TRUE(report.findings.empty());
}

TEST(CheckTopology, FindsOneHoleInATorus) {
    const SurfaceReport report = check_of(torus(100), {.closed = true});
    EXPECT_EQ(report.euler, 0);
    EXPECT_EQ(report.genus, Genus{1});
    EXPECT_TRUE(report.clean);
}

TEST(CheckTopology, GivesTheGenusOfEachClosedComponentAndNoneOfOpenOnes) {
    Soup soup = octahedron();
    soup.add(square().moved(5, 0, 0)).add(torus(12).moved(20, 0, 0)).add(octahedron().moved(40, 0, 0));
    const SurfaceReport report = check_of(soup);
    EXPECT_EQ(report.components, 4u);
    EXPECT_EQ(report.euler, 2 + 1 + 0 + 2);
    EXPECT_EQ(report.genus, (Genus{0, 1, 0}));
    EXPECT_FALSE(report.closed);
    EXPECT_TRUE(report.clean); // nobody said that it must be closed
}

TEST(CheckTopology, CountsComponentsByVerticesThatTrianglesShare) {
    Soup soup;
    for (int i = 0; i < 5000; ++i) soup.add(octahedron().moved(static_cast<float>(3 * i), 0, 0));
    const SurfaceReport report = check_of(soup);
    EXPECT_EQ(report.components, 5000u);
    EXPECT_EQ(report.genus, Genus(5000, 0));
    EXPECT_TRUE(report.clean);
}

TEST(CheckTopology, TakesTwoTrianglesBackToBackForASphere) {
    const SurfaceReport report = check_of({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}});
    EXPECT_TRUE(report.closed);
    EXPECT_EQ(report.euler, 2);
    EXPECT_EQ(report.double_sheets, 1u);
}

TEST(CheckTopology, LeavesUnusedVerticesOutOfEulerCharacteristicAndComponents) {
    Soup soup = octahedron();
    soup.vertices.insert(soup.vertices.begin(), {9, 9, 9});
    for (auto& t : soup.triangles) t = {t[0] + 1, t[1] + 1, t[2] + 1};
    const SurfaceReport report = check_of(soup);
    EXPECT_EQ(report.unused_vertices, 1u);
    EXPECT_EQ(report.euler, 2);
    EXPECT_EQ(report.components, 1u);
    EXPECT_TRUE(report.clean);
}

TEST(CheckTopology, CallsAnEmptySurfaceClosedAndClean) {
    const SurfaceReport report = check(Surface{}, {.closed = true}).value();
    EXPECT_TRUE(report.closed);
    EXPECT_TRUE(report.clean);
    EXPECT_EQ(report.components, 0u);
    EXPECT_EQ(report.area, 0);
    EXPECT_EQ(report.volume, 0);
}

} // namespace
