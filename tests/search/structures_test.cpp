// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the structures promise beyond finding: memory, few seeds, neighbours that agree.
#include <algorithm>
#include <array>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <isotet/paper/search.hpp>

#include "packed/tet_table.hpp"
#include "paper/search/face_neighbours.hpp"
#include "paper/search/seed_set.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

using core::TetTable;
using search::FaceNeighbours;

TetTable table_of(const Grid& grid, const PointField& field) {
    return core::make_tet_table(pack(grid, field, {.split_cells = true}).value().data()).value();
}

TEST(TetTables, HoldTetsOnly) {
    const Grid grid = made_grid("mixed", 5, {"gyroid"});
    const auto table = core::make_tet_table(pack(grid, point_field(grid)).value().data());
    ASSERT_FALSE(table);
    EXPECT_EQ(table.error().code, ErrorCode::invalid_argument);
    EXPECT_NE(table.error().message.find("pack it with split_cells"), std::string::npos);
}

TEST(TetTables, HoldSixteenBytesATetAndAPoint) {
    const Grid grid = made_grid("mixed", 5, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid), {.split_cells = true}).value();
    const TetTable table = core::make_tet_table(packed.data()).value();
    EXPECT_EQ(table.bytes(), 16 * (packed.report().tets + packed.report().points));
    EXPECT_EQ(table.clusters(), packed.report().clusters);
    std::multiset<float> values, expected;
    for (const auto& point : table.points) values.insert(point[3]);
    for (std::size_t p = 0; p < grid.points.tuples(); ++p)
        expected.insert(static_cast<float>(grid.point_fields[0].values.at(p)));
    EXPECT_EQ(values, expected);
}

TEST(FaceNeighbours, ShareThreePointsAndAgree) {
    for (const std::uint32_t seed : Seeds(1, 4)) {
        const NastyGrid g = nasty_grid(seed, {.side = 5, .values = 0, .missing = 0.1});
        const TetTable table = table_of(g.grid, g.field);
        const FaceNeighbours neighbours(table);
        std::map<std::array<std::uint32_t, 3>, int> faces;
        const auto face_of = [&](std::uint32_t tet, unsigned corner) {
            const auto& v = table.tets[tet];
            std::array face{v[(corner + 1) % 4], v[(corner + 2) % 4], v[(corner + 3) % 4]};
            std::sort(face.begin(), face.end());
            return face;
        };
        for (std::uint32_t tet = 0; tet < table.tets.size(); ++tet)
            for (unsigned k = 0; k < 4; ++k) faces[face_of(tet, k)] += !table.range(tet).is_empty();
        for (std::uint32_t tet = 0; tet < table.tets.size(); ++tet)
            for (unsigned k = 0; k < 4; ++k) {
                const std::uint32_t other = neighbours.of(tet)[k];
                const bool shared = !table.range(tet).is_empty() && faces[face_of(tet, k)] == 2;
                ASSERT_EQ(other != FaceNeighbours::none, shared);
                if (!shared) continue;
                const auto& back = neighbours.of(other);
                const auto at = std::find(back.begin(), back.end(), tet);
                ASSERT_NE(at, back.end());
                ASSERT_EQ(face_of(tet, k), face_of(other, static_cast<unsigned>(at - back.begin())));
            }
    }
}

TEST(SeedSets, AreSmallOnSmoothFieldsAndNeverEmptyWhereSomethingIsCut) {
    const Grid grid = made_grid("shuffled", 20, {"gyroid"});
    const TetTable table = table_of(grid, point_field(grid));
    const search::SeedSet seeds(table);
    EXPECT_GT(seeds.seeds(), 0u);
    EXPECT_LT(20 * seeds.seeds(), table.tets.size());
}

TEST(TetIndexReports, TellTheBytesThatTheHeadersPromise) {
    const Grid grid = made_grid("shuffled", 20, {"gyroid"});
    const PackedGrid packed = pack(grid, point_field(grid), {.split_cells = true}).value();
    const auto bytes = [&](SearchIndex index) {
        const TetIndexReport report = TetIndex::create(packed, index).value().report();
        return static_cast<double>(report.index_bytes) / static_cast<double>(report.tets);
    };
    EXPECT_LT(bytes(SearchIndex::cluster_ranges), 0.5);
    EXPECT_GE(bytes(SearchIndex::interval_tree), 16);
    EXPECT_LT(bytes(SearchIndex::interval_tree), 32);
    EXPECT_LT(bytes(SearchIndex::octree), 8);
    EXPECT_GE(bytes(SearchIndex::seed_set), 16);
    EXPECT_LT(bytes(SearchIndex::seed_set), 18);
    EXPECT_DOUBLE_EQ(bytes(SearchIndex::span_space), 12);
}

} // namespace
} // namespace isotet::test
