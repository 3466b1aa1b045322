// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces of random grids are those of a brute-force weld written straight from the contract: the same vertices, bit
// for bit, and the same triangles up to the diagonals of quadrilaterals.
#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/brute_weld.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

template <class Real>
void expect_equal_to_weld(const Grid& grid, const PointField& field, const std::vector<double>& isovalues,
                          const std::string& which) {
    PackOptions pack_options;
    pack_options.source_cells = pack_options.split_cells = true;
    pack_options.precision = std::is_same_v<Real, float> ? Precision::float32 : Precision::float64;
    const PackedGrid packed = pack(grid, field, pack_options).value();
    for (const double isovalue : isovalues)
        for (const Ties ties : {Ties::merge, Ties::keep}) {
            ExtractOptions options;
            options.ties = ties;
            options.edge_ends = true;
            options.source_cells = true;
            const Surface surface = extract(packed, isovalue, options).value().surface;
            const SurfaceSets found = sets_of(surface), wanted = brute_weld<Real>(grid, field.values, isovalue, ties);
            const std::string place =
                which + ", isovalue " + std::to_string(isovalue) + (ties == Ties::keep ? ", kept" : "");
            ASSERT_EQ(surface.vertex_count(), wanted.vertices.size()) << place;
            ASSERT_EQ(surface.triangle_count(), wanted.triangle_count()) << place;
            ASSERT_EQ(found.vertices, wanted.vertices) << place;
            ASSERT_EQ(found, wanted) << place;
        }
}

template <class Real = float>
void expect_equal_to_weld(std::uint32_t seed, const NastyOptions& nasty, const std::vector<double>& isovalues) {
    const NastyGrid g = nasty_grid(seed, nasty);
    expect_equal_to_weld<Real>(g.grid, g.field, isovalues, "seed " + std::to_string(seed));
}

TEST(BruteWeld, EqualsSurfacesOfIntegerFields) {
    for (const std::uint32_t seed : Seeds(100, 30))
        expect_equal_to_weld(seed, {.side = 2 + int(seed) % 6, .values = 2 + int(seed) % 4}, {-1, 0, 1, 1.5});
}

TEST(BruteWeld, EqualsSurfacesOfSmoothFields) {
    for (const std::uint32_t seed : Seeds(200, 4)) expect_equal_to_weld(seed, {.side = 9, .values = 0}, {-1, 0.1});
}

TEST(BruteWeld, EqualsSurfacesBesidePointsWithoutData) {
    for (const std::uint32_t seed : Seeds(300, 30))
        expect_equal_to_weld(seed, {.side = 3 + int(seed) % 5, .values = 3, .no_data = 0.05 * (seed % 6)}, {0, 0.5, 1});
}

TEST(BruteWeld, EqualsSurfacesOfTangledGridsWithRepeatedAndMissingTets) {
    for (const std::uint32_t seed : Seeds(400, 30))
        expect_equal_to_weld(seed,
                             {.side = 3 + int(seed) % 5,
                              .values = 3,
                              .no_data = 0.02,
                              .missing = 0.3,
                              .inverted = 0.3,
                              .mirrored = 0.5,
                              .repeated = 0.2},
                             {0, 0.5, 1});
}

TEST(BruteWeld, EqualsSurfacesOfDoublePackings) {
    for (const std::uint32_t seed : Seeds(500, 10))
        expect_equal_to_weld<double>(seed, {.side = 5, .values = int(seed % 2) * 3, .no_data = 0.02, .wide = true},
                                     {0, 0.3, 1});
}

TEST(BruteWeld, EqualsSurfacesOfSplitCells) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed"}) {
        const Grid grid = made_grid(shape, 5, {"integer"}, 7);
        std::vector<float> values;
        for (const std::int32_t v : grid.point_fields[0].values.as<std::int32_t>())
            values.push_back(static_cast<float>(v));
        expect_equal_to_weld<float>(grid, field_of(std::move(values)), {1, 2, 2.5}, shape);
    }
}

TEST(BruteWeld, KeepsFlatTetsAsTheFileHasThem) {
    // A square's four corners are a flat tet between two upright ones; once more with every tet mirrored.
    const std::vector<std::array<double, 3>> points{{0, 0, 0}, {1, 0, 0},     {1, 1, 0},
                                                    {0, 1, 0}, {0.5, 0.5, 1}, {0.5, 0.5, -1}};
    const std::vector<Corners> upright{{0, 1, 2, 4}, {0, 2, 3, 4}, {0, 2, 1, 3}, {0, 3, 1, 5}, {1, 3, 2, 5}};
    std::vector<Corners> mirrored = upright;
    for (Corners& tet : mirrored) std::swap(tet[1], tet[2]);
    for (const auto& tets : {upright, mirrored})
        for (int pattern = 0; pattern < 729; ++pattern) {
            std::vector<float> values;
            for (int rest = pattern; values.size() < points.size(); rest /= 3)
                values.push_back(static_cast<float>(rest % 3 - 1));
            expect_equal_to_weld<float>(tet_grid(points, tets), field_of(values), {0},
                                        "pattern " + std::to_string(pattern));
        }
}

} // namespace
} // namespace isotet::test
