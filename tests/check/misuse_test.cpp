// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces that are none, and options that do not fit, are errors that name what was seen.
#include <atomic>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "check/made_surface.hpp"

namespace {

using namespace isotet;
using namespace isotet::test;

void expect_error(const Surface& surface, const CheckOptions& options, ErrorCode code, const std::string& part) {
    const auto report = check(surface, options);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, code);
    EXPECT_NE(report.error().message.find(part), std::string::npos) << report.error().message;
}

TEST(CheckMisuse, NamesTheFirstTriangleWithAVertexOutOfRange) {
    Soup soup = octahedron();
    soup.triangles[3][1] = 6;
    soup.triangles[5][1] = 4000000000u;
    expect_error(surface_of(soup), {}, ErrorCode::invalid_data,
                 "triangles[3] has vertex 6, but the surface has 6 vertices");
}

TEST(CheckMisuse, RefusesNegativeNumbersOfVertices) {
    Surface surface = surface_of(octahedron());
    surface.triangles = Array::own(std::vector<std::int32_t>{0, 1, -2}, 3);
    expect_error(surface, {}, ErrorCode::invalid_data, "triangles[0] has vertex -2");
}

TEST(CheckMisuse, NamesThePositionThatIsNotFinite) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        Soup soup = octahedron();
        soup.vertices[2][1] = bad;
        expect_error(surface_of(soup), {}, ErrorCode::invalid_data, "vertex 2 is at (0, ");
    }
}

TEST(CheckMisuse, RefusesArraysOfTheWrongTypeOrShape) {
    Surface surface = surface_of(octahedron());
    surface.positions = Array::own(std::vector<std::int32_t>(18), 3);
    expect_error(surface, {}, ErrorCode::invalid_data, "positions are int32 with 3 components");
    surface.positions = Array::own(std::vector<float>(18), 2);
    expect_error(surface, {}, ErrorCode::invalid_data, "positions are float32 with 2 components");
    surface = surface_of(octahedron());
    surface.triangles = Array::own(std::vector<float>(9), 3);
    expect_error(surface, {}, ErrorCode::invalid_data, "triangles are float32 with 3 components");
    surface.triangles = Array::own(std::vector<std::uint32_t>(8), 4);
    expect_error(surface, {}, ErrorCode::invalid_data, "triangles are uint32 with 4 components");
}

TEST(CheckMisuse, RefusesTrianglesWithoutAnyVertex) {
    Surface surface;
    surface.triangles = Array::own(std::vector<std::uint32_t>{0, 0, 0}, 3);
    expect_error(surface, {}, ErrorCode::invalid_data, "triangles[0] has vertex 0, but the surface has 0 vertices");
}

TEST(CheckMisuse, AsksForEdgeEndsWhenThereIsAGrid) {
    const Grid grid;
    expect_error(surface_of(octahedron()), {.grid = &grid}, ErrorCode::invalid_argument, "edge_ends has 0 tuples");
}

TEST(CheckMisuse, EndsWithCancelledWhenItIsCancelled) {
    const std::atomic<bool> cancel{true};
    Progress progress;
    progress.cancel = &cancel;
    const auto report = check(surface_of(octahedron()), {}, {.progress = progress});
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::cancelled);
}

} // namespace
