// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Area and volume: values, signs, and the same bits every time.
#include <cmath>

#include <gtest/gtest.h>

#include "base/parallel.hpp"
#include "check/made_surface.hpp"

namespace {

using namespace isotet;
using namespace isotet::test;

TEST(CheckMeasures, KnowsAreaAndVolumeOfAnOctahedron) {
    const SurfaceReport report = check_of(octahedron());
    EXPECT_NEAR(report.area, 4 * std::sqrt(3.0), 1e-12);
    EXPECT_NEAR(report.volume, 4.0 / 3, 1e-12);
    EXPECT_EQ(area(surface_of(octahedron())), report.area);
}

TEST(CheckMeasures, GivesANegativeVolumeWhenNormalsLookInward) {
    EXPECT_NEAR(check_of(octahedron().mirrored()).volume, -4.0 / 3, 1e-12);
}

TEST(CheckMeasures, KeepsItsDigitsFarFromTheOrigin) {
    EXPECT_NEAR(check_of(octahedron().moved(4194304, 0, 0)).volume, 4.0 / 3, 1e-12);
}

TEST(CheckMeasures, GivesTheSameBitsOnAnyNumberOfThreads) {
    const Surface surface = surface_of(torus(200));
    double areas[3], volumes[3];
    for (int i = 0; i < 3; ++i)
        core::with_threads(1 + 3 * i, [&] {
            const SurfaceReport report = check(surface).value();
            areas[i] = report.area;
            volumes[i] = report.volume;
        });
    EXPECT_EQ(areas[0], areas[1]);
    EXPECT_EQ(areas[0], areas[2]);
    EXPECT_EQ(volumes[0], volumes[1]);
    EXPECT_EQ(volumes[0], volumes[2]);
}

TEST(CheckMeasures, ReadsDoublesAndLongIndices) {
    const Soup soup = octahedron();
    std::vector<double> positions;
    for (const auto& v : soup.vertices) positions.insert(positions.end(), v.begin(), v.end());
    std::vector<std::uint64_t> triangles;
    for (const auto& t : soup.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
    Surface surface;
    surface.positions = Array::own(std::move(positions), 3);
    surface.triangles = Array::own(std::move(triangles), 3);
    const SurfaceReport report = check(surface, {.closed = true}).value();
    EXPECT_TRUE(report.clean);
    EXPECT_EQ(report.volume, check_of(soup).volume);
}

TEST(CheckMeasures, HasNoAreaForASurfaceThatIsBroken) {
    Surface surface = surface_of(octahedron());
    surface.positions = Array::own(std::vector<float>{0, 0, 0}, 3);
    EXPECT_TRUE(std::isnan(area(surface)));
}

} // namespace
