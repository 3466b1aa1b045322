// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include <isotet/fields.hpp>
#include <isotet/solid.hpp>

#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

ContourInput input_of(const Grid& grid) { return {grid, find_field(grid, "gyroid").value(), {}, {}}; }

TEST(SolidMisuse, RangesMustAscendAndHaveAFiniteEnd) {
    const Grid grid = made_grid("kuhn", 3, {"gyroid"});
    Solids solids = Solids::create(input_of(grid)).value();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    for (const SolidRange& range : {SolidRange{1, 1}, SolidRange{2, 1}, SolidRange{-infinity, infinity},
                                    SolidRange{std::numeric_limits<double>::quiet_NaN(), 1}}) {
        const auto solid = solids.extract(range);
        ASSERT_FALSE(solid);
        EXPECT_EQ(solid.error().code, ErrorCode::invalid_argument);
    }
}

TEST(SolidMisuse, OptionsThatSolidsDoNotKnowAreErrors) {
    const Grid grid = made_grid("kuhn", 3, {"gyroid"});
    ContourOptions kept, exact, normals;
    kept.ties = Ties::keep;
    exact.exact_vertices = true;
    normals.normals = Normals::gradient;
    for (const ContourOptions& options : {kept, exact, normals}) {
        const auto solids = Solids::create(input_of(grid), options);
        ASSERT_FALSE(solids);
        EXPECT_EQ(solids.error().code, ErrorCode::invalid_argument);
    }
}

TEST(SolidMisuse, AMovedFromMakerAnswers) {
    const Grid grid = made_grid("kuhn", 3, {"gyroid"});
    Solids solids = Solids::create(input_of(grid)).value();
    const Solids other = std::move(solids);
    EXPECT_EQ(solids.extract(SolidRange::above(0)).error().code, ErrorCode::invalid_argument); // NOLINT
    EXPECT_GT(other.grid_volume(), 0);
}

TEST(Solid, IsTheWholeGridOrNothingWhereTheIsovalueIsOutsideTheRange) {
    const Grid grid = made_grid("mixed", 3, {"gyroid"});
    Solids solids = Solids::create(input_of(grid)).value();
    const Solid all = solids.extract(SolidRange::above(-100)).value();
    EXPECT_NEAR(all.volume, solids.grid_volume(), 1e-6 * solids.grid_volume());
    EXPECT_EQ(all.isosurface_triangles, 0u);
    EXPECT_EQ(solids.extract(SolidRange::above(100)).value().surface.triangle_count(), 0u);
}

} // namespace
} // namespace isotet::test
