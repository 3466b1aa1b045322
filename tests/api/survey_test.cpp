// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What survey() counts, against grids whose counts are known, and that memory and the width of point numbers change
// nothing.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <isotet/boundary.hpp>
#include <isotet/grid.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>

#include "base/parallel.hpp"
#include "grid/boundary_search.hpp"
#include "grid/faces.hpp"
#include "grid/mixed_faces.hpp"
#include "support/mixed_grid.hpp"
#include "support/random_grid.hpp"
#include "support/surface_bytes.hpp"

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

TEST(Survey, CountsTheBoundaryOfManyTetsInAnyOrder) {
    for (const auto& [shape, threads] : {std::pair("kuhn", 1), {"shuffled", 7}}) {
        const GridReport report = survey(cube_of(48, shape), {}, {.threads = threads}).value(); // 663,552 tets
        EXPECT_EQ(report.boundary_faces, 6u * 48 * 48 * 2) << shape;
        EXPECT_EQ(report.repeated_tets, 0u) << shape;
        EXPECT_EQ(report.duplicate_points, 0u) << shape;
    }
}

/// A cube of hexahedra of which one is replaced by its tets.
Grid hexahedra_beside_tets(std::uint64_t side, std::size_t replaced) {
    const Grid hexahedra = cube_of(side, "hex");
    const TetList list = split(hexahedra).value();
    std::vector<std::int64_t> corners, offsets{0};
    std::vector<std::uint8_t> types;
    const auto add = [&](CellType type, const auto& points) {
        corners.insert(corners.end(), points.begin(), points.end());
        offsets.push_back(static_cast<std::int64_t>(corners.size()));
        types.push_back(static_cast<std::uint8_t>(type));
    };
    for (std::size_t cell = 0; cell < hexahedra.cells.count(); ++cell) {
        if (cell == replaced) continue;
        std::vector<std::int64_t> points;
        for (std::size_t k = 0; k < 8; ++k)
            points.push_back(static_cast<std::int64_t>(hexahedra.cells.connectivity.at(8 * cell + k)));
        add(CellType::hexahedron, points);
    }
    for (std::size_t t = 0; t < list.tets.size(); ++t)
        if (list.cells[t] == replaced) add(CellType::tetrahedron, list.tets[t]);
    Grid grid = hexahedra;
    grid.cells.connectivity = Array::own(std::move(corners));
    grid.cells.offsets = Array::own(std::move(offsets));
    grid.cells.types = Array::own(std::move(types));
    return grid;
}

TEST(Survey, CountsQuadrilateralsThatMeetTriangles) {
    EXPECT_EQ(survey(hexahedra_beside_tets(3, 0)).value().quads_on_triangles, 3u);  // in a corner
    EXPECT_EQ(survey(hexahedra_beside_tets(3, 13)).value().quads_on_triangles, 6u); // in the middle
    for (const char* shape : {"kuhn", "hex", "wedge", "pyramid", "mixed"})
        EXPECT_EQ(survey(cube_of(6, shape)).value().quads_on_triangles, 0u) << shape;
}

TEST(Survey, CountsQuadrilateralsAlikeWithLittleMemory) {
    const Grid grid = hexahedra_beside_tets(24, 7000);
    const core::CellReader cells = core::CellReader::open(grid).value();
    EXPECT_EQ(core::count_quads_on_triangles(cells, std::uint64_t{1} << 30, {}), 6u);
    EXPECT_EQ(core::count_quads_on_triangles(cells, 0, {}), 6u);
}

TEST(Survey, WithoutFacesCountsAllElseAlike) {
    const NastyGrid g = nasty_grid(3, {.side = 6, .inverted = 0.1, .mirrored = 0.3, .repeated = 0.1});
    GridReport all = survey(g.grid).value();
    const GridReport quick = survey(g.grid, {.faces = false}).value();
    EXPECT_GT(all.repeated_tets, 0u);
    EXPECT_GT(all.boundary_faces, 0u);
    EXPECT_EQ(quick.repeated_tets + quick.duplicate_points + quick.boundary_faces, 0u);
    EXPECT_EQ(quick.points, all.points);
    EXPECT_EQ(quick.cells_by_type, all.cells_by_type);
    EXPECT_EQ(quick.tets, all.tets);
    EXPECT_EQ(quick.negative_tets, all.negative_tets);
    EXPECT_EQ(quick.inverted_tets, all.inverted_tets);
    EXPECT_EQ(quick.flat_tets, all.flat_tets);
    EXPECT_EQ(quick.unused_points, all.unused_points);
    EXPECT_EQ(quick.lower, all.lower);
    EXPECT_EQ(quick.upper, all.upper);
}

TEST(Survey, CountsCellsByType) {
    const Grid grid = cube_of(6, "mixed");
    std::map<std::uint8_t, std::size_t> expected;
    for (const std::uint8_t type : grid.cells.types.as<std::uint8_t>()) ++expected[type];
    EXPECT_GT(expected.size(), 3u);
    EXPECT_EQ(survey(grid).value().cells_by_type, expected);
    EXPECT_EQ(survey(cube_of(3)).value().cells_by_type, (std::map<std::uint8_t, std::size_t>{{10, 162}}));
}

/// Tets far apart, each with four points of its own, at the places that `at` tells.
template <class At>
Grid lone_tets(std::size_t tets, const At& at) {
    std::vector<double> points;
    std::vector<std::int64_t> corners;
    for (std::size_t i = 0; i < 4 * tets; ++i) {
        const std::array<double, 3> position = at(i);
        points.insert(points.end(), position.begin(), position.end());
        corners.push_back(static_cast<std::int64_t>(i));
    }
    Grid grid;
    grid.points = Array::own(std::move(points), 3);
    grid.cells.connectivity = Array::own(std::move(corners));
    return grid;
}

TEST(Survey, CountsPointsInOnePlace) {
    constexpr std::size_t tets = 50'000;
    const auto lattice = [](std::size_t i) {
        return std::array{static_cast<double>(i % 100), static_cast<double>(i / 100 % 100),
                          static_cast<double>(i / 10'000)};
    };
    EXPECT_EQ(survey(lone_tets(tets, lattice)).value().duplicate_points, 0u);
    EXPECT_EQ(survey(lone_tets(tets, [&](std::size_t i) { return lattice(i % 1000); })).value().duplicate_points,
              4 * tets - 1000);
    EXPECT_EQ(survey(lone_tets(tets, [](std::size_t) { return std::array{1.0, 2.0, 3.0}; })).value().duplicate_points,
              4 * tets - 1);
    const auto zeros = [](std::size_t i) { return std::array{i % 2 ? 0.0 : -0.0, static_cast<double>(i), 0.0}; };
    EXPECT_EQ(survey(lone_tets(tets, zeros)).value().duplicate_points, 0u) << "the second coordinates differ";
    const auto signs = [](std::size_t i) { return std::array{i % 2 ? 0.0 : -0.0, 7.0, static_cast<double>(i / 2)}; };
    EXPECT_EQ(survey(lone_tets(tets, signs)).value().duplicate_points, 2 * tets) << "-0 equals +0";
}

TEST(Survey, CountsNoDuplicatesAmongUnusedPoints) {
    Grid grid;
    grid.points = Array::own(std::vector<float>{5, 5, 5, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 5, 5, 5, 0, 0, 1}, 3);
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{1, 2, 3, 4});
    const GridReport report = survey(grid).value();
    EXPECT_EQ(report.unused_points, 3u);
    EXPECT_EQ(report.duplicate_points, 0u);
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
        for (const double repeated : {0.0, 0.1}) {
            const NastyGrid g =
                nasty_grid(seed, {.side = 5, .missing = 0.1, .inverted = 0.1, .mirrored = 0.3, .repeated = repeated});
            const GridReport report = survey(g.grid).value();
            const PackedGrid packed = pack(g.grid, g.field).value();
            EXPECT_EQ(report.tets - report.repeated_tets, packed.report().tets);
            EXPECT_EQ(report.repeated_tets, packed.report().repeated_tets);
            EXPECT_EQ(report.repeated_tets > 0, repeated > 0);
            EXPECT_GT(report.negative_tets, 0u);
            if (repeated > 0) continue; // packing counts the tets that it keeps
            EXPECT_EQ(report.negative_tets, packed.report().negative_tets);
            EXPECT_EQ(report.inverted_tets, packed.report().inverted_tets);
            EXPECT_EQ(report.flat_tets, packed.report().flat_tets);
        }
    }
}

/// How often the stored tets use each face as its points ascend, less how often mirrored: by a plain map.
std::map<std::array<std::uint64_t, 3>, int> balance_by_map(const Grid& grid, const core::CellReader& cells,
                                                           bool mostly_negative) {
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
    return balance;
}

std::uint64_t boundary_faces_by_map(const Grid& grid, const core::CellReader& cells, bool mostly_negative) {
    const auto balance = balance_by_map(grid, cells, mostly_negative);
    return std::uint64_t(
        std::count_if(balance.begin(), balance.end(), [](const auto& face) { return face.second != 0; }));
}

/// Coordinates as multiples of 1/4.
Array rounded(const Array& points) {
    std::vector<double> out(points.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = std::round(4 * points.at(i / 3, i % 3)) / 4;
    return Array::own(std::move(out), 3);
}

/// Tets, or from seed 5 on cells of other kinds: those of odd seeds inside out, moved and collapsed here and there.
NastyGrid nasty_cells(std::uint32_t seed) {
    if (seed <= 4)
        return nasty_grid(seed, {.side = 9, .missing = 0.1, .inverted = 0.1, .mirrored = 0.3, .repeated = 0.2});
    const double some = seed % 2 ? 0.2 : 0;
    return mixed_grid(seed, {.shape = seed <= 8 ? "mixed" : seed <= 10 ? "hex" : "wedge",
                             .side = 6,
                             .missing = 0.1,
                             .mirrored = some,
                             .repeated = 0.1,
                             .moved = some,
                             .collapsed = some});
}

TEST(Survey, FindsTheSameFacesOfAllKindsOfCellsBySumsAndByCountingAll) {
    for (std::uint32_t seed = 5; seed <= 12; ++seed) {
        const NastyGrid g = nasty_cells(seed);
        const core::CellReader cells = core::CellReader::open(g.grid).value();
        const core::TetSurvey tets = core::survey_tets(g.grid, cells);
        const auto found = [&](std::uint64_t memory) {
            return core::survey_faces(g.grid, cells, tets, {memory, false, 1 << 20}, {}).value();
        };
        const core::FaceSurvey all = found(0), some = found(std::uint64_t{1} << 30);
        EXPECT_EQ(some.repeated, all.repeated) << "seed " << seed;
        EXPECT_GT(all.faces.size(), 0u);
        EXPECT_TRUE(std::ranges::equal(some.faces, all.faces, [](const auto& a, const auto& b) {
            return a.points == b.points && a.mirrored == b.mirrored;
        })) << "seed " << seed;
    }
}

TEST(Survey, CountsFacesAlikeWithAnyMemoryAndWidth) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        NastyGrid g = nasty_cells(seed);
        if (seed % 2) g.grid.points = rounded(g.grid.points); // flat tets, also repeated the other way round
        const core::CellReader cells = core::CellReader::open(g.grid).value();
        const core::TetSurvey tets = core::survey_tets(g.grid, cells);
        const std::uint64_t expected = boundary_faces_by_map(g.grid, cells, tets.mostly_negative());
        const std::uint64_t repeated = survey(g.grid).value().repeated_tets;
        for (const std::uint64_t memory : {std::uint64_t{1} << 30, std::uint64_t{20000}, std::uint64_t{0}})
            for (const bool wide : {false, true}) {
                const auto faces = core::survey_faces(g.grid, cells, tets, {memory, wide}, {}).value();
                EXPECT_EQ(faces.boundary_faces, expected) << "seed " << seed << ", memory " << memory;
                EXPECT_EQ(faces.repeated, repeated) << "seed " << seed << ", memory " << memory;
            }
    }
}

TEST(Survey, FindsTheSameFacesWithAnyMemoryWidthAndThreads) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        NastyGrid g = nasty_cells(seed);
        if (seed == 4) g.grid = make_grid({.shape = "mixed", .side = 7, .fields = {}}).value();
        if (seed % 2) g.grid.points = rounded(g.grid.points);
        const core::CellReader cells = core::CellReader::open(g.grid).value();
        const core::TetSurvey tets = core::survey_tets(g.grid, cells);
        std::map<std::array<std::uint64_t, 3>, int> expected = balance_by_map(g.grid, cells, tets.mostly_negative());
        std::erase_if(expected, [](const auto& face) { return face.second == 0; });
        for (const std::uint64_t memory : {std::uint64_t{1} << 30, std::uint64_t{0}})
            for (const bool wide : {false, true})
                for (const int threads : {1, 2, 5}) {
                    std::vector<core::BoundaryFace> faces;
                    core::with_threads(threads, [&] {
                        faces = core::find_boundary_faces(g.grid, cells, tets, {memory, wide}, {}).value();
                    });
                    ASSERT_EQ(faces.size(), expected.size()) << "seed " << seed << ", memory " << memory;
                    EXPECT_TRUE(std::ranges::equal(faces, expected,
                                                   [](const auto& face, const auto& other) {
                                                       return face.points == other.first &&
                                                              face.mirrored == (other.second < 0);
                                                   }))
                        << "seed " << seed << ", memory " << memory << ", " << threads << " threads";
                }
    }
}

TEST(Survey, FindsTheBoundaryOfCellsThatGoByInBlocks) {
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        NastyGrid g = nasty_cells(seed);
        if (seed == 4) g.grid = make_grid({.shape = "mixed", .side = 7, .fields = {}}).value();
        if (seed == 5) g.grid = make_grid({.shape = "hex", .side = 9, .fields = {}}).value();
        if (seed == 6) g.grid = make_grid({.shape = "shuffled", .side = 9, .fields = {}}).value();
        if (seed % 2) g.grid.points = rounded(g.grid.points);
        const core::CellReader cells = core::CellReader::open(g.grid).value();
        const core::TetSurvey tets = core::survey_tets(g.grid, cells);
        std::map<std::array<std::uint64_t, 3>, int> expected = balance_by_map(g.grid, cells, tets.mostly_negative());
        std::erase_if(expected, [](const auto& face) { return face.second == 0; });
        for (const std::size_t block : {1, 7, 100000}) {
            core::BoundarySearch search(g.grid.points);
            for (std::size_t begin = 0; begin < cells.count(); begin += block)
                search.add(g.grid, cells, begin, std::min(begin + block, cells.count()));
            ASSERT_TRUE(search.look());
            for (std::size_t end = cells.count(); end > 0; end -= std::min(block, end))
                search.keep(end - std::min(block, end), cells, end - std::min(block, end), end);
            ASSERT_TRUE(search.has_kept_all());
            const core::FoundBoundary found = std::move(search).finish({}).value();
            std::vector<std::array<std::uint64_t, 3>> faces;
            for (std::size_t i = 0; i < found.surface.triangle_count(); ++i) {
                std::array<std::uint64_t, 3> face{};
                for (std::size_t k = 0; k < 3; ++k)
                    face[k] = static_cast<std::uint64_t>(
                        found.surface.edge_ends.at(static_cast<std::size_t>(found.surface.triangles.at(i, k)), 0));
                const bool odd = (face[0] > face[1]) ^ (face[0] > face[2]) ^ (face[1] > face[2]);
                std::ranges::sort(face);
                const auto known = expected.find(face);
                ASSERT_NE(known, expected.end()) << "seed " << seed;
                EXPECT_EQ(odd, known->second < 0) << "seed " << seed;
                faces.push_back(face);
            }
            EXPECT_EQ(faces.size(), expected.size()) << "seed " << seed;
            EXPECT_TRUE(std::ranges::is_sorted(faces));
        }
    }
}

TEST(Survey, FindsTheBoundaryOfCellsThatTakeMoreMemoryThanMayBeKept) {
    for (const char* shape : {"shuffled", "mixed"}) {
        const Grid grid = make_grid({.shape = shape, .side = 7, .fields = {}}).value();
        const core::CellReader cells = core::CellReader::open(grid).value();
        core::BoundarySearch search(grid.points);
        search.limit_kept(1000);
        search.add(grid, cells, 0, cells.count());
        ASSERT_TRUE(search.look());
        search.keep(0, cells, 0, cells.count() / 2);
        search.keep(cells.count() / 2, cells, cells.count() / 2, cells.count());
        ASSERT_FALSE(search.has_kept_all());
        const Surface found = std::move(search).finish(grid, cells, {}).value();
        EXPECT_TRUE(bytes_of(found) == bytes_of(boundary_of(grid).value()));
    }
}

TEST(Survey, FindsThatBlocksWhichGoByAgainAreBroken) {
    const Grid grid = make_grid({.shape = "mixed", .side = 4, .fields = {}}).value();
    const core::CellReader cells = core::CellReader::open(grid).value();
    for (const bool typed : {false, true}) {
        core::BoundarySearch search(grid.points);
        search.add(grid, cells, 0, cells.count());
        ASSERT_TRUE(search.look());
        const Array broken = Array::own(std::vector<float>(12)); // no point numbers
        if (typed) search.keep(0, std::vector<std::uint8_t>{10, 10, 10}, broken);
        else search.keep(0, CellType::tetrahedron, broken);
        EXPECT_FALSE(search.has_kept_all());
    }
}

TEST(Survey, FindsThatCellsWhichGoByAgainHaveOtherPoints) {
    for (const char* shape : {"shuffled", "mixed"})
        for (const std::int64_t point : {std::int64_t{-1}, std::int64_t{1} << 40}) {
            Grid grid = make_grid({.shape = shape, .side = 4, .fields = {}}).value();
            const core::CellReader cells = core::CellReader::open(grid).value();
            core::BoundarySearch search(grid.points);
            search.add(grid, cells, 0, cells.count());
            ASSERT_TRUE(search.look());
            std::vector<std::int64_t> corners;
            for (std::size_t i = 0; i < grid.cells.connectivity.size(); ++i)
                corners.push_back(static_cast<std::int64_t>(cells.corner(i)));
            corners[corners.size() / 2] = point;
            grid.cells.connectivity = Array::own(std::move(corners), grid.cells.connectivity.components());
            search.keep(0, core::CellReader::open(grid).value(), 0, cells.count());
            EXPECT_FALSE(search.has_kept_all());
        }
}

TEST(Survey, FindsThatEveryTetIsRepeated) {
    const Grid once = make_grid({.shape = "kuhn", .side = 6, .fields = {}}).value();
    const auto corners = once.cells.connectivity.as<std::int32_t>();
    std::vector<std::int32_t> twice(corners.begin(), corners.end());
    twice.insert(twice.end(), corners.begin(), corners.end());
    Grid grid = once;
    grid.cells.connectivity = Array::own(std::move(twice), once.cells.connectivity.components());
    const GridReport report = survey(grid).value();
    EXPECT_EQ(report.repeated_tets, 6u * 6 * 6 * 6);
    EXPECT_EQ(report.boundary_faces, 6u * 6 * 6 * 2);
}

} // namespace
} // namespace isotet::test
