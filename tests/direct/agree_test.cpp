// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces of random grids from plain arrays: the engines agree, the packed grid gives the same, and so does the weld
// written straight from the contract.
#include "direct/direct_support.hpp"
#include "support/close_values.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

void expect_seed_agrees(std::uint32_t seed, const NastyOptions& nasty, const std::vector<double>& isovalues,
                        Precision precision = Precision::float32) {
    const NastyGrid g = nasty_grid(seed, nasty);
    expect_agreement(g.grid, g.field, isovalues, precision, {{"value", g.field.values}});
}

TEST(Once, AgreesOnSmoothFields) {
    for (const std::uint32_t seed : Seeds(1, 4))
        expect_seed_agrees(seed, {.side = 11, .values = 0}, {-2, -0.4, 0, 0.3, 2});
}

TEST(Once, AgreesOnIntegerFieldsFullOfTies) {
    for (const std::uint32_t seed : Seeds(1, 12))
        expect_seed_agrees(seed, {.side = 4 + int(seed) % 6, .values = 2 + int(seed) % 4}, {-1, 0, 0.5, 1, 2});
}

TEST(Once, AgreesBesidePointsWithoutData) {
    for (const std::uint32_t seed : Seeds(1, 12))
        expect_seed_agrees(seed, {.side = 4 + int(seed) % 6, .values = 4, .no_data = 0.05 * (seed % 5)},
                           {-1, 0, 1, 1.5});
}

TEST(Once, AgreesOnTangledGridsWithRepeatedAndMissingTets) {
    for (const std::uint32_t seed : Seeds(1, 12))
        expect_seed_agrees(seed,
                           {.side = 3 + int(seed) % 5,
                            .values = 3,
                            .no_data = 0.03,
                            .missing = 0.3,
                            .inverted = 0.2,
                            .mirrored = 0.5,
                            .repeated = 0.1},
                           {0, 0.5, 1});
}

TEST(Once, AgreesInDoublePrecision) {
    for (const std::uint32_t seed : Seeds(1, 6))
        expect_seed_agrees(seed, {.side = 7, .values = int(seed % 2) * 4, .no_data = 0.02, .wide = true}, {0, 0.25, 1},
                           Precision::float64);
}

TEST(Once, AgreesOnFloat64CoordinatesInSinglePrecision) {
    for (const std::uint32_t seed : Seeds(1, 6))
        expect_seed_agrees(seed,
                           {.side = 6, .values = int(seed % 2) * 4, .missing = seed % 3 ? 0.3 : 0.97, .wide = true},
                           {0, 0.25, 1});
}

TEST(Once, AgreesOnCloseValues) {
    for (const bool far_values : {false, true}) {
        const CloseValues close{.far_values = far_values};
        const Grid grid = made_grid("shuffled", 8, {"gyroid"});
        expect_agreement(grid, close.field(grid), {close.isovalue(2, 0.3), close.isovalue(3, 0)});
    }
}

TEST(Once, AgreesOnCellsOfAllTypes) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed", "layer", "perturbed"}) {
        SCOPED_TRACE(shape);
        const Grid grid = made_grid(shape, 5, {"integer", "gyroid"}, 7);
        expect_agreement(grid, point_field(grid, 0), {1, 2, 2.5}, Precision::float32, grid.point_fields);
        expect_agreement(grid, point_field(grid, 1), {-0.5, 0, 0.1}, Precision::float32, grid.point_fields);
    }
}

TEST(Once, AgreesOnGridsOfSeveralChunks) {
    for (const char* shape : some_of<const char*>({"mixed", "kuhn", "shuffled"})) {
        SCOPED_TRACE(shape);
        const Grid grid = made_grid(shape, 24, {"gyroid"}); // 13,824 to 82,944 cells
        const DirectOptions options = with_everything(Ties::merge, Precision::float32);
        expect_surfaces_of_clusters(grid, point_field(grid), {0.1}, options,
                                    extract_on_both(grid, point_field(grid), {0.1}, options));
    }
}

TEST(Once, GivesTheVerticesAndTrianglesOfABruteForceWeld) {
    for (const std::uint32_t seed : Seeds(100, 10)) {
        const NastyGrid g =
            nasty_grid(seed, {.side = 2 + int(seed) % 6, .values = 2 + int(seed) % 4, .no_data = 0.02, .missing = 0.1});
        for (const double isovalue : {0.0, 0.1, 0.5, 1.0})
            for (const Ties ties : {Ties::merge, Ties::keep})
                ASSERT_EQ(sets_of(surface_once(g.grid, g.field, isovalue, with_everything(ties, Precision::float32))),
                          brute_weld<float>(g.grid, g.field.values, isovalue, ties))
                    << isovalue;
    }
}

TEST(Once, OrdersVerticesByTheirEndsAndTrianglesByTheirCells) {
    const NastyGrid g = nasty_grid(5, {.side = 8, .values = 3, .no_data = 0.02});
    const Surface surface = surface_once(g.grid, g.field, 0, with_everything(Ties::merge, Precision::float32));
    const auto ordered = [&](std::size_t vertex) {
        const auto [below, above] = ends_of(surface, vertex);
        return std::pair(std::min(below, above), std::max(below, above));
    };
    for (std::size_t v = 1; v < surface.vertex_count(); ++v) ASSERT_LT(ordered(v - 1), ordered(v));
    const auto cells = surface.source_cells.as<std::int64_t>();
    ASSERT_TRUE(std::is_sorted(cells.begin(), cells.end()));
    ASSERT_GT(surface.triangle_count(), 1000u);
}

} // namespace
} // namespace isotet::test
