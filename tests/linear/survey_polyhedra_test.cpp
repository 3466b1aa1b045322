// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// survey() splits polyhedra block by block, and counts what linearize() makes of all of them.
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/make.hpp>

#include "linear/polyhedral_grid.hpp"

namespace isotet::test {
namespace {

void expect_as_linear(const Grid& grid, const std::string& what) {
    SCOPED_TRACE(what);
    const auto linear = linearize({grid.points, grid.cells, {}, {}});
    const auto counted = survey(grid, {.faces = false});
    ASSERT_EQ(bool(linear), bool(counted));
    if (!linear) return;
    const GridReport expected = survey(linear->grid, {.faces = false}).value();
    EXPECT_EQ(counted->points, grid.points.tuples());
    EXPECT_EQ(counted->cells, grid.cells.count());
    EXPECT_EQ(counted->cells_left_out, expected.cells_left_out);
    EXPECT_EQ(counted->tets, expected.tets);
    EXPECT_EQ(counted->collapsed_tets, expected.collapsed_tets);
    EXPECT_EQ(counted->negative_tets, expected.negative_tets);
    EXPECT_EQ(counted->inverted_tets, expected.inverted_tets);
    EXPECT_EQ(counted->flat_tets, expected.flat_tets);
    EXPECT_EQ(counted->unused_points, expected.unused_points);
    EXPECT_EQ(counted->lower, expected.lower);
    EXPECT_EQ(counted->upper, expected.upper);
}

Grid as_doubles(Grid grid) {
    std::vector<double> places;
    for (std::size_t i = 0; i < grid.points.size(); ++i) places.push_back(grid.points.at(i / 3, i % 3) * 1.1);
    grid.points = Array::own(std::move(places), 3);
    return grid;
}

/// Points far from where they were: cells fold, and some see no centre.
Grid shaken(Grid grid, double by) {
    std::mt19937 random(7);
    std::vector<float> places;
    for (std::size_t i = 0; i < grid.points.size(); ++i) {
        const double step = static_cast<double>(random() % 2001) / 1000 - 1;
        places.push_back(static_cast<float>(grid.points.at(i / 3, i % 3) + by * step));
    }
    places.insert(places.end(), {9, 9, 9}); // in no cell
    grid.points = Array::own(std::move(places), 3);
    return grid;
}

TEST(SurveyPolyhedra, CountsWhatLinearizeMakes) {
    const Grid kelvin = make_grid({.shape = "kelvin", .side = 9, .fields = {}}).value();
    expect_as_linear(kelvin, "kelvin");
    expect_as_linear(as_doubles(kelvin), "kelvin in double");
    for (const double by : {0.02, 0.1, 0.5}) expect_as_linear(shaken(kelvin, by), "shaken kelvin");
    const Grid mixed = make_grid({.shape = "mixed", .side = 6, .fields = {}}).value();
    expect_as_linear(as_polyhedra(mixed, Listed::as_corners, 3), "known shapes");
    expect_as_linear(as_polyhedra(mixed, Listed::ascending, 3), "known shapes in any order");
    for (const unsigned seed : {1U, 2U, 3U}) {
        expect_as_linear(octree_grid({.seed = seed}), "octree");
        expect_as_linear(octree_grid({.seed = seed, .moved = 0.6}), "octree, folded");
    }
    const Grid octree = make_grid({.shape = "octree-bent", .side = 6, .fields = {}}).value();
    expect_as_linear(close_hanging_points(octree).value().grid, "hexahedra and polyhedra");
}

TEST(SurveyPolyhedra, CountsOpenOnesAsLeftOut) {
    const CellFaces tetrahedron{{0, 1, 2}, {0, 1, 3}, {1, 2, 3}, {0, 2, 3}};
    const CellFaces open{{0, 1, 2}, {0, 1, 3}, {1, 2, 3}};
    PolyhedronList list;
    list.add(tetrahedron);
    list.add(open);
    list.add_linear(1, {3});
    Grid grid;
    grid.points = Array::own(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 5, 5, 5}, 3);
    grid.cells = list.cells();
    expect_as_linear(grid, "one is open");
    EXPECT_EQ(survey(grid, {.faces = false}).value().cells_left_out, 2U);
    EXPECT_EQ(survey(grid, {.faces = false}).value().unused_points, 1U);

    PolyhedronList none;
    none.add(open);
    grid.cells = none.cells();
    const auto counted = survey(grid, {.faces = false});
    ASSERT_FALSE(counted);
    EXPECT_EQ(counted.error().message, linearize(grid).error().message);
}

TEST(SurveyPolyhedra, PassesOverPointsThatAreNotFiniteWhereNoCellHasThem) {
    Grid grid = make_grid({.shape = "kelvin", .side = 2, .fields = {}}).value();
    std::vector<float> places;
    for (std::size_t i = 0; i < grid.points.size(); ++i)
        places.push_back(static_cast<float>(grid.points.at(i / 3, i % 3)));
    places.insert(places.end(), 3, std::numeric_limits<float>::quiet_NaN());
    grid.points = Array::own(std::move(places), 3);
    expect_as_linear(grid, "a point that is not a number");
    EXPECT_EQ(survey(grid, {.faces = false}).value().unused_points, 1U);
}

} // namespace
} // namespace isotet::test
