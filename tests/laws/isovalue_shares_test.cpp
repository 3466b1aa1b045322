// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Isovalues of shares have that share of the volume, or of the point values, below them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <gtest/gtest.h>

#include <isotet/isovalues.hpp>

#include "grid/cell_block.hpp"
#include "support/random_grid.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

using enum IsovalueShare::Of;

std::vector<double> isovalues_of(const Grid& grid, const PointField& field, const std::vector<IsovalueShare>& shares) {
    return isovalues_at(grid, field, shares).value();
}

double share_below(const Grid& grid, const PointField& field, double isovalue) {
    const auto out = contour_spectrum(grid, field, std::vector<double>{isovalue}).value();
    return out.volume_below[0] / out.volume;
}

TEST(IsovalueOfAVolumeShare, OfOneTetIsTheRootOfItsCubic) {
    const Grid grid = tet_grid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
    const PointField field = field_of(std::vector<double>{0, 1, 1, 1}); // the volume below t is t cubed
    const auto found = isovalues_of(grid, field, {{volume, 12.5}, {volume, 0}, {volume, 100}, {volume, 1e-4}});
    EXPECT_NEAR(found[0], 0.5, 1e-11);
    EXPECT_EQ(found[1], 0);
    EXPECT_EQ(found[2], 1);
    EXPECT_NEAR(found[3], 0.01, 1e-8);
}

TEST(IsovalueOfAVolumeShare, HasThatShareBelow) {
    const std::vector<double> percents{0.1, 10, 50, 90, 99.9};
    for (const char* shape : {"perturbed", "layer", "mixed", "kelvin"}) {
        const Grid grid = made_grid(shape, 5, {"wavelet"}); // without tets of one value
        std::vector<IsovalueShare> shares;
        for (const double percent : percents) shares.push_back({volume, percent});
        const std::vector<double> isovalues = isovalues_of(grid, point_field(grid), shares);
        const auto out = contour_spectrum(grid, point_field(grid), isovalues).value();
        for (std::size_t i = 0; i < percents.size(); ++i)
            EXPECT_NEAR(out.volume_below[i] / out.volume, percents[i] / 100, 2e-12) << shape << " " << percents[i];
    }
}

TEST(IsovalueOfAVolumeShare, IsTheSameBesideOthersAndForAnyNumberOfThreads) {
    const Grid grid = made_grid("perturbed", 18, {"gyroid"});
    const std::vector<IsovalueShare> shares{{volume, 90}, {points, 5}, {volume, 10}, {volume, 90}};
    const auto one = isovalues_at(grid, point_field(grid), shares, {.threads = 1}).value();
    EXPECT_EQ(isovalues_at(grid, point_field(grid), shares, {.threads = 2}).value(), one);
    EXPECT_EQ(isovalues_at(grid, point_field(grid), shares, {.threads = 7}).value(), one);
    EXPECT_EQ(one[0], one[3]);
    EXPECT_LT(one[2], one[0]);
}

/// So many cells of one type at a time.
CellsInTurn in_turn(const Grid& grid, std::size_t corners_of_cell, std::size_t at_once) {
    const Array& all = grid.cells.connectivity;
    const std::size_t cells = all.size() / corners_of_cell;
    const auto each = [=, bare = Grid{grid.points, {}, {}, {}}](const auto& take) -> Result<void> {
        for (std::size_t first = 0; first < cells; first += at_once) {
            std::vector<std::uint64_t> corners;
            for (std::size_t i = first * corners_of_cell; i < std::min(first + at_once, cells) * corners_of_cell; ++i)
                corners.push_back(static_cast<std::uint64_t>(all.at(i)));
            take(first, core::block_of(bare, corners_of_cell == 4 ? CellType::tetrahedron : CellType::hexahedron,
                                       Array::own(std::move(corners))));
        }
        return {};
    };
    return {cells, each};
}

TEST(IsovalueOfAVolumeShare, IsTheSameOfCellsThatGoBy) {
    const std::vector<IsovalueShare> shares{{volume, 90}, {points, 5}, {volume, 37.5}};
    for (const auto& [shape, side, corners] :
         {std::tuple("perturbed", std::uint64_t{18}, std::size_t{4}), {"hex", 34, 8}}) {
        const Grid grid = made_grid(shape, side, {"gyroid"}); // of two blocks of sums
        const PointField field = point_field(grid);
        const auto whole = isovalues_of(grid, field, shares);
        for (const std::size_t at_once : {1'000, 16'384, 100'000})
            EXPECT_EQ(isovalues_at(grid.points, in_turn(grid, corners, at_once), field, shares).value(), whole)
                << shape;
    }
}

TEST(IsovalueOfAVolumeShare, OfBrokenCellsThatGoByIsAnError) {
    const Grid grid = tet_grid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 9}});
    const PointField field = field_of(std::vector<double>{0, 1, 1, 1});
    const auto found = isovalues_at(grid.points, in_turn(grid, 4, 1), field, std::vector<IsovalueShare>{{volume, 50}});
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, ErrorCode::invalid_data);
}

TEST(IsovalueOfAVolumeShare, IsTheValueWhereTetsOfOneValueJumpOverIt) {
    const Grid grid =
        tet_grid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {5, 0, 1}},
                 {{0, 1, 2, 3}, {0, 2, 1, 4}, {5, 6, 7, 8}});
    const PointField field =
        field_of(std::vector<float>{3, 3, 3, 3, 1, 7, 7, 7, 7}); // a third below 3, one at 3, one at 7
    const auto found = isovalues_of(grid, field, {{volume, 50}, {volume, 80}, {volume, 20}});
    EXPECT_EQ(found[0], 3);
    EXPECT_EQ(found[1], 7);
    EXPECT_NEAR(share_below(grid, field, found[2]), 0.2, 1e-12);
}

TEST(IsovalueOfAVolumeShare, HoldsForValuesOfAnyMagnitude) {
    const Grid grid = tet_grid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
    const double most = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
    for (const std::vector<double>& values : {std::vector<double>{-most, most, most, most},
                                              {0, least, least, 4 * least},
                                              {1, 1, 1, std::nextafter(1.0, 2)},
                                              {5, 5, 5, 5}}) {
        const double found = isovalues_of(grid, field_of(values), {{volume, 50}})[0];
        EXPECT_GE(found, values[0]);
        EXPECT_LE(found, values[3]);
    }
    EXPECT_NEAR(isovalues_of(grid, field_of(std::vector<double>{-most, most, most, most}), {{volume, 12.5}})[0], 0,
                most * 1e-11);
}

TEST(IsovalueOfAPointShare, IsTheNearestRank) {
    const Grid grid = tet_grid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, {{0, 1, 2, 3}});
    const double none = std::numeric_limits<double>::quiet_NaN();
    const PointField field = field_of(std::vector<double>{40, 10, 30, 20, none});
    const auto found =
        isovalues_of(grid, field, {{points, 0}, {points, 25}, {points, 26}, {points, 95}, {points, 100}});
    EXPECT_EQ(found, (std::vector<double>{10, 10, 20, 40, 40}));
}

TEST(IsovalueShares, AreRefusedWhereThereIsNothingToShare) {
    const Grid grid = tet_grid({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}});
    const PointField field = field_of(std::vector<double>{0, 1, 1, 1});
    for (const double percent : {-1.0, 101.0, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_EQ(isovalues_at(grid, field, std::vector<IsovalueShare>{{points, percent}}).error().code,
                  ErrorCode::invalid_argument);
    const double none = std::numeric_limits<double>::quiet_NaN();
    const PointField nothing = field_of(std::vector<double>{none, none, none, none});
    for (const IsovalueShare::Of of : {volume, points})
        EXPECT_EQ(isovalues_at(grid, nothing, std::vector<IsovalueShare>{{of, 50}}).error().code,
                  ErrorCode::invalid_data);
    const PointField some = field_of(std::vector<double>{none, 1, 2, 3});
    EXPECT_EQ(isovalues_at(grid, some, std::vector<IsovalueShare>{{volume, 50}}).error().message,
              "the tets where field 'value' has values have no volume");
    EXPECT_TRUE(isovalues_at(grid, field, {}).value().empty());
}

TEST(IsovalueOfAVolumeShare, HoldsOnGridsWithHolesAndInvertedTets) {
    for (const std::uint32_t seed : {1, 2, 3}) {
        NastyOptions nasty;
        nasty.values = 0;
        nasty.no_data = 0.02;
        nasty.missing = 0.1;
        nasty.inverted = 0.1;
        const NastyGrid made = nasty_grid(seed, nasty);
        const double isovalue = isovalues_of(made.grid, made.field, {{volume, 30}})[0];
        EXPECT_NEAR(share_below(made.grid, made.field, isovalue), 0.3, 2e-12) << seed;
    }
}

} // namespace
} // namespace isotet::test
