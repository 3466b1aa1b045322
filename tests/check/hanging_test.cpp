// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Hanging points: cells beside smaller ones that share no faces with them. They are counted, and a surface that is open
// there is not called clean.
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/grid.hpp>

#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

using Place = std::array<double, 3>;

struct Cubes {
    Place lowest;
    double edge;
    int count; ///< a direction
};

enum class Corner { shared, apart };

/// Hexahedra in cubes of cubes; points of the same place are one, or each cell has its own.
Grid grid_of_cubes(
    const std::vector<Cubes>& blocks, Corner kind = Corner::shared,
    const std::function<Place(Place)>& moved = [](Place p) { return p; }) {
    constexpr int corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    std::map<Place, std::int64_t> known;
    std::vector<double> points;
    std::vector<std::int64_t> connectivity;
    for (const Cubes& block : blocks)
        for (int i = 0; i < block.count * block.count * block.count; ++i) {
            const std::array<int, 3> cell{i % block.count, i / block.count % block.count,
                                          i / block.count / block.count};
            for (const auto& corner : corners) {
                Place place;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    place[axis] = block.lowest[axis] + block.edge * (cell[axis] + corner[axis]);
                const auto next = static_cast<std::int64_t>(points.size() / 3);
                const auto [at, is_new] = known.emplace(place, next);
                connectivity.push_back(is_new || kind == Corner::apart ? next : at->second);
                if (is_new || kind == Corner::apart)
                    for (const double x : moved(place)) points.push_back(x);
            }
        }
    std::vector<std::int64_t> offsets;
    for (std::size_t i = 0; i <= connectivity.size(); i += 8) offsets.push_back(static_cast<std::int64_t>(i));
    Grid grid;
    grid.points = Array::own(std::move(points), 3);
    grid.cells.types = Array::own(std::vector<std::uint8_t>(offsets.size() - 1, 12));
    grid.cells.offsets = Array::own(std::move(offsets));
    grid.cells.connectivity = Array::own(std::move(connectivity));
    return grid;
}

/// A coarse cube beside `count`^3 fine ones.
std::vector<Cubes> coarse_and_fine(int count) { return {{{0, 0, 0}, 2, 1}, {{2, 0, 0}, 2.0 / count, count}}; }

/// Bent about an axis, so that hanging points are not in the plane of the larger face.
Place bent(Place p) {
    const double angle = 0.2 * p[1], radius = 5 + p[0];
    return {radius * std::cos(angle), radius * std::sin(angle), p[2]};
}

SurfaceReport report_of(const Grid& grid, double isovalue, bool split_cells = false, bool conforming = false) {
    std::vector<double> heights;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i) heights.push_back(grid.points.at(i, 2));
    const PointField field{"height", Array::own(std::move(heights)), false, {}};
    ContourOptions options;
    options.edge_ends = true;
    options.split_cells = split_cells;
    const auto result = Contour::create({grid, field, {}, {}}, options).value().extract(isovalue).value();
    CheckOptions how{.grid = &grid, .field = &field, .split_cells = split_cells, .conforming = conforming};
    return check(result.surfaces[0].surface, how).value();
}

std::uint64_t hanging_points(const Grid& grid) { return count_hanging_points(grid).value(); }

TEST(HangingPoints, AreCountedBetweenLevels) {
    EXPECT_EQ(hanging_points(grid_of_cubes(coarse_and_fine(1))), 0u);
    EXPECT_EQ(hanging_points(grid_of_cubes(coarse_and_fine(2))), 9u - 4);
    EXPECT_EQ(hanging_points(grid_of_cubes(coarse_and_fine(4))), 25u - 4);
    EXPECT_EQ(hanging_points(grid_of_cubes({{{0, 0, 0}, 2, 2}, {{4, 0, 0}, 1, 4}})), 25u - 9);
    EXPECT_EQ(hanging_points(grid_of_cubes({{{0, 0, 0}, 2, 1}, {{2, 0, 0}, 1, 2}, {{-0.5, 0, 0}, 0.5, 4}})), 5u)
        << "the third block overlaps nothing: its faces are no part of the larger ones";
}

TEST(HangingPoints, AreCountedWhereEachCellHasItsOwnPoints) {
    EXPECT_EQ(hanging_points(grid_of_cubes(coarse_and_fine(2), Corner::apart)), 5u);
    EXPECT_EQ(hanging_points(grid_of_cubes({{{0, 0, 0}, 1, 3}}, Corner::apart)), 0u);
}

TEST(HangingPoints, AreCountedAtCurvedShapes) {
    EXPECT_EQ(hanging_points(grid_of_cubes(coarse_and_fine(2), Corner::shared, bent)), 5u);
    const auto sideways = [](Place p) { return bent({p[1], p[0], p[2]}); };
    EXPECT_EQ(hanging_points(grid_of_cubes(coarse_and_fine(2), Corner::shared, sideways)), 5u);
}

TEST(HangingPoints, AreNotWhereFacesMeetOrTheGridIsThin) {
    for (const char* shape : {"kuhn", "hex", "wedge", "pyramid", "mixed"})
        EXPECT_EQ(hanging_points(made_grid(shape, 4, {})), 0u) << shape;
    const auto thin = [](Place p) { return Place{p[0], p[1], 0.01 * p[2] * (p[0] + 0.01)}; };
    EXPECT_EQ(hanging_points(grid_of_cubes({{{0, 0, 0}, 1, 4}}, Corner::shared, thin)), 0u);
    const auto edge = [](Place p) { return Place{p[0], p[1] * (1 + p[0]), 0.1 * p[2] * p[0]}; };
    EXPECT_EQ(hanging_points(grid_of_cubes({{{0, 0, 0}, 1, 4}}, Corner::shared, edge)), 0u);
}

TEST(HangingPoints, OpenTheSurfaceWhichIsThenNotClean) {
    for (const bool split_cells : {false, true}) {
        const SurfaceReport open = report_of(grid_of_cubes(coarse_and_fine(2)), 0.7, split_cells);
        EXPECT_TRUE(open.sound);
        EXPECT_FALSE(open.clean);
        EXPECT_GE(open.hanging_edges, 3u) << "one of the larger cell, two of smaller ones, and more by diagonals";
        EXPECT_LT(open.hanging_edges, open.boundary_edges) << "others are at the boundary of the grid";
        ASSERT_FALSE(open.findings.empty());
        EXPECT_NE(open.findings[0].what.find("is open at a hanging point"), std::string::npos);
        const SurfaceReport closed = report_of(grid_of_cubes(coarse_and_fine(1)), 0.7, split_cells);
        EXPECT_EQ(closed.hanging_edges, 0u);
        EXPECT_TRUE(closed.clean);
    }
    EXPECT_EQ(report_of(grid_of_cubes(coarse_and_fine(2)), 0.7).hanging_edges, 3u);
}

/// As of curved cells, of which only those near the isovalues are kept: their rims are no levels.
TEST(HangingPoints, AreNotLookedForInAGridThatConforms) {
    const Grid grid = grid_of_cubes(coarse_and_fine(2));
    const SurfaceReport levels = report_of(grid, 0.7), conforming = report_of(grid, 0.7, false, true);
    EXPECT_GT(levels.hanging_edges, 0u);
    EXPECT_EQ(conforming.hanging_edges, 0u);
    EXPECT_EQ(conforming.boundary_edges, levels.boundary_edges);
    EXPECT_TRUE(conforming.sound);
}

} // namespace
} // namespace isotet::test
