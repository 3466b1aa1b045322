// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What survey() counts, against grids whose counts are known, and that dealing points into hands changes nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include <isotet/grid.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>

#include "core/faces.hpp"
#include "support/random_grid.hpp"

namespace isotet::test {
namespace {

Grid cube_of(std::uint64_t side, const char* shape = "kuhn") {
    return make_grid({.shape = shape, .side = side, .fields = {"sphere"}}).value();
}

TEST(Survey, CountsTheBoundaryOfACube) {
    for (const char* shape : {"kuhn", "shuffled", "hex"}) {
        const GridReport report = survey(cube_of(5, shape)).value();
        EXPECT_EQ(report.boundary_faces, 6u * 5 * 5 * 2) << shape;
        EXPECT_EQ(report.repeated_tets, 0u) << shape;
        EXPECT_EQ(report.inverted_tets, 0u) << shape;
        EXPECT_EQ(report.flat_tets, 0u) << shape;
        EXPECT_EQ(report.duplicate_points, 0u) << shape;
        EXPECT_EQ(report.unused_points, 0u) << shape;
        EXPECT_EQ(report.lower, (std::array{-1.0, -1.0, -1.0})) << shape;
        EXPECT_EQ(report.upper, (std::array{1.0, 1.0, 1.0})) << shape;
    }
}

TEST(Survey, CountsOddTets) {
    // An upright tet, the same listed again in another order, a mirrored one beside it, a flat one, and a collapsed
    // one.
    Grid grid;
    grid.points =
        Array::own(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1, 0.5, 0.5, 0, 9, 9, 9, 0, 0, 0}, 3);
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0,
                                                                   1,
                                                                   2,
                                                                   3,
                                                                   3,
                                                                   2,
                                                                   1,
                                                                   0,
                                                                   /* on the far side of 1 2 3 */ 1,
                                                                   2,
                                                                   3,
                                                                   4,
                                                                   /* mirrored */ 7,
                                                                   2,
                                                                   1,
                                                                   3,
                                                                   /* flat */ 0,
                                                                   1,
                                                                   2,
                                                                   5,
                                                                   /* collapsed */ 0,
                                                                   0,
                                                                   1,
                                                                   2});
    const GridReport report = survey(grid).value();
    EXPECT_EQ(report.tets, 5u);
    EXPECT_EQ(report.collapsed_tets, 1u);
    EXPECT_EQ(report.repeated_tets, 1u);
    EXPECT_EQ(report.flat_tets, 1u);
    EXPECT_EQ(report.negative_tets, 1u);
    EXPECT_EQ(report.inverted_tets, 1u);
    EXPECT_EQ(report.unused_points, 1u);
    EXPECT_EQ(report.duplicate_points, 1u);
}

TEST(Survey, BoundsAreThoseOfTheTetsWhereverOtherCellsStand) {
    constexpr std::size_t vertices = 200'000; // enough for some threads to see nothing else
    std::vector<std::int64_t> corners{0, 1, 2, 3}, offsets{0};
    std::vector<std::uint8_t> types{static_cast<std::uint8_t>(CellType::tetrahedron)};
    corners.resize(4 + vertices, 4);
    types.resize(1 + vertices, 1);
    for (std::size_t i = 4; i <= corners.size(); ++i) offsets.push_back(static_cast<std::int64_t>(i));
    Grid grid;
    grid.points = Array::own(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3, 9, 9, 9}, 3);
    grid.cells.connectivity = Array::own(std::move(corners));
    grid.cells.offsets = Array::own(std::move(offsets));
    grid.cells.types = Array::own(std::move(types));
    const GridReport report = survey(grid).value();
    EXPECT_EQ(report.lower, (std::array{0.0, 0.0, 0.0}));
    EXPECT_EQ(report.upper, (std::array{1.0, 2.0, 3.0}));
}

TEST(Survey, AgreesWithPackingOnNastyGrids) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        const NastyGrid g =
            nasty_grid(seed, {.side = 5, .missing = 0.1, .inverted = 0.1, .mirrored = 0.3, .repeated = 0.1});
        const GridReport report = survey(g.grid).value();
        const PackedGrid packed = pack(g.grid, g.field).value();
        EXPECT_EQ(report.tets - report.repeated_tets, packed.report().tets);
        EXPECT_EQ(report.repeated_tets, packed.report().repeated_tets);
        EXPECT_EQ(report.negative_tets, packed.report().negative_tets);
        EXPECT_EQ(report.inverted_tets, packed.report().inverted_tets);
        EXPECT_EQ(report.flat_tets, packed.report().flat_tets);
        EXPECT_GT(report.repeated_tets, 0u);
        EXPECT_GT(report.negative_tets, 0u);
    }
}

/// Boundary faces by a plain map over the stored tets.
std::uint64_t boundary_faces_by_map(const Grid& grid, const core::CellReader& cells, bool mostly_negative) {
    const core::Orienter orienter(grid.points, mostly_negative);
    core::Orienter::Counts counts;
    std::set<std::set<std::uint64_t>> seen;
    std::map<std::array<std::uint64_t, 3>, int> balance;
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        const core::CellTets tets = cells.tets(cell);
        for (unsigned piece = 0; piece < unsigned(tets.count); ++piece) {
            if (!seen.insert(std::set<std::uint64_t>(tets.tets[piece].begin(), tets.tets[piece].end())).second)
                continue;
            const core::Tet t = orienter.stored(cells.type(cell), tets, piece, counts);
            for (const auto& f : {std::array{t[1], t[2], t[3]}, std::array{t[0], t[3], t[2]},
                                  std::array{t[0], t[1], t[3]}, std::array{t[0], t[2], t[1]}}) {
                auto sorted = f;
                std::sort(sorted.begin(), sorted.end());
                // Even permutations of the sorted corners are its rotations.
                const bool even = f == sorted || f == std::array{sorted[1], sorted[2], sorted[0]} ||
                                  f == std::array{sorted[2], sorted[0], sorted[1]};
                balance[sorted] += even ? 1 : -1;
            }
        }
    }
    return std::uint64_t(
        std::count_if(balance.begin(), balance.end(), [](const auto& face) { return face.second != 0; }));
}

TEST(Survey, CountsTheSameInOneHandOrMany) {
    for (std::uint32_t seed = 1; seed <= 3; ++seed) {
        const NastyGrid g =
            nasty_grid(seed, {.side = 5, .missing = 0.1, .inverted = 0.1, .mirrored = 0.3, .repeated = 0.1});
        const core::CellReader cells = core::CellReader::open(g.grid).value();
        const core::TetSurvey tets = core::survey_tets(g.grid, cells);
        const std::uint64_t expected = boundary_faces_by_map(g.grid, cells, tets.mostly_negative);
        const std::uint64_t repeated = survey(g.grid).value().repeated_tets;
        for (const std::uint64_t memory : {std::uint64_t{1} << 30, std::uint64_t{20000}, std::uint64_t{3000}}) {
            const auto faces = core::survey_faces(g.grid, cells, tets, memory, {}).value();
            EXPECT_EQ(faces.boundary_faces, expected) << "seed " << seed << ", memory " << memory;
            EXPECT_EQ(faces.repeated, repeated) << "seed " << seed << ", memory " << memory;
        }
    }
}

} // namespace
} // namespace isotet::test
