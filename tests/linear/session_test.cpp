// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sessions on polyhedra: fields, steps, points, cells and what is told of them.
#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/boundary.hpp>
#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>

#include "linear/polyhedral_grid.hpp"
#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

PointField axis_field(const Grid& grid, std::size_t axis) {
    std::vector<float> values(grid.points.tuples());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(grid.points.at(i, axis));
    return {axis == 0 ? "x" : "y", Array::own(std::move(values)), false, {}};
}

Field cell_numbers(const Grid& grid) {
    std::vector<std::int32_t> numbers(grid.cells.count());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::int32_t>(i);
    return {"number", Array::own(std::move(numbers))};
}

TEST(PolyhedralSession, GivesTheUsersCellsAndCarriesBothKindsOfFields) {
    const Grid grid = octree_grid({.seed = 3});
    for (const Method method : {Method::clusters, Method::direct}) {
        ContourInput input{grid, axis_field(grid, 0), {{"y", axis_field(grid, 1).values}}, {cell_numbers(grid)}};
        auto session = Contour::create(input, {.method = method, .source_cells = true}).value();
        const ContourResult result = session.extract(2.9).value();
        const Surface& surface = result.surfaces[0].surface;
        ASSERT_GT(surface.triangle_count(), 0u);
        ASSERT_EQ(surface.cell_fields[0].values.tuples(), surface.triangle_count());
        for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
            ASSERT_LT(surface.source_cells.at(t), static_cast<double>(grid.cells.count()));
            ASSERT_EQ(surface.source_cells.at(t), surface.cell_fields[0].values.at(t));
        }
        for (std::size_t v = 0; v < surface.vertex_count(); ++v)
            ASSERT_NEAR(surface.point_fields[0].values.at(v), surface.positions.at(v, 1), 1e-5);
    }
}

TEST(PolyhedralSession, TellsWhatWasSplitOnce) {
    const Grid grid = octree_grid({.seed = 3});
    auto session = Contour::create({grid, axis_field(grid, 0), {}, {}}).value();
    const auto told = session.extract(3).value().notes;
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0].find("polyhedra were split around a point inside"), std::string::npos) << told[0];
    EXPECT_TRUE(session.extract(2).value().notes.empty());
    ASSERT_TRUE(session.linear_grid());
    EXPECT_EQ(session.linear_grid()->user_points, grid.points.tuples());
}

TEST(PolyhedralSession, StoresOnlyWhatChanges) {
    const Grid grid = octree_grid({.seed = 4});
    auto session = Contour::create({grid, axis_field(grid, 0), {}, {}}, {.method = Method::clusters}).value();
    ASSERT_TRUE(session.extract(3));
    const auto table = session.linear_grid()->derived.points.data();
    EXPECT_EQ(session.set({grid, axis_field(grid, 0), {}, {}}).value(), ContourUpdate::nothing);
    EXPECT_EQ(session.set({grid, axis_field(grid, 1), {}, {}}).value(), ContourUpdate::field);
    ASSERT_TRUE(session.extract(3));
    Grid moved = grid;
    std::vector<double> points(grid.points.as<double>().begin(), grid.points.as<double>().end());
    for (double& x : points) x = 1.5 * x + 1;
    moved.points = Array::own(std::move(points), 3);
    EXPECT_EQ(session.set({moved, axis_field(moved, 1), {}, {}}).value(), ContourUpdate::points);
    EXPECT_EQ(session.linear_grid()->derived.points.data(), table) << "the same derived points";
    const Surface surface = session.extract(5.2).value().surfaces[0].surface;
    ASSERT_GT(surface.vertex_count(), 0u);
    for (std::size_t v = 0; v < surface.vertex_count(); ++v) ASSERT_NEAR(surface.positions.at(v, 1), 5.2, 1e-5);
    const Grid other = octree_grid({.seed = 5});
    EXPECT_EQ(session.set({other, axis_field(other, 0), {}, {}}).value(), ContourUpdate::grid);
    EXPECT_EQ(bytes_of(session.extract(3).value().surfaces[0].surface),
              bytes_of(Contour::create({other, axis_field(other, 0), {}, {}}, {.method = Method::clusters})
                           .value()
                           .extract(3)
                           .value()
                           .surfaces[0]
                           .surface));
    const Grid linear = made_grid("hex", 4, {"sphere"}, 1);
    ASSERT_TRUE(session.set({linear, {"sphere", linear.point_fields[0].values, false, {}}, {}, {}}));
    EXPECT_FALSE(session.linear_grid());
}

TEST(PolyhedralSession, StaysAsItWasAfterAnError) {
    const Grid grid = octree_grid({.seed = 4});
    auto session = Contour::create({grid, axis_field(grid, 0), {}, {}}).value();
    const std::string before = bytes_of(session.extract(3).value().surfaces[0].surface);
    const Grid other = octree_grid({.seed = 5});
    EXPECT_FALSE(session.set({other, {"short", Array::own(std::vector<float>(7)), false, {}}, {}, {}}));
    EXPECT_EQ(bytes_of(session.extract(3).value().surfaces[0].surface), before);
}

TEST(PolyhedralSession, GivesCentresTheValuesOfTheirCells) {
    Grid grid = octree_grid({.seed = 3});
    std::vector<float> values(grid.cells.count());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i % 7);
    grid.cell_fields = {{"c", Array::own(std::move(values))}};
    FindFieldOptions keep;
    keep.keep_cell_values = true;
    const PointField own = find_field(grid, "c", keep).value(), mean = find_field(grid, "c").value();
    EXPECT_EQ(own.cell_values.tuples(), grid.cells.count());
    EXPECT_TRUE(mean.cell_values.empty());
    const LinearGrid linear = linearize(grid).value();
    const auto surface_of = [&](const PointField& field) {
        return bytes_of(Contour::create({grid, field, {}, {}}).value().extract(3.2).value().surfaces[0].surface);
    };
    PointField extended = own;
    extended.values = linear.extend(own.values, own.cell_values).value();
    const double isovalue = 3.2;
    const auto wanted = extract_direct(linear.grid, extended, std::span(&isovalue, 1)).value();
    EXPECT_TRUE(surface_of(own) == bytes_of(wanted.surfaces[0].surface));
    EXPECT_FALSE(surface_of(own) == surface_of(mean));
    ContourOptions expected;
    expected.surfaces = 1;
    expected.expected_isovalues = {isovalue}; // all are split: a cell's own value may be beyond its corners'
    EXPECT_TRUE(
        surface_of(own) ==
        bytes_of(Contour::create({grid, own, {}, {}}, expected).value().extract(3.2).value().surfaces[0].surface));
}

TEST(PolyhedralGrids, AverageCellFieldsAsTheCellsThatTheyAre) {
    Grid grid = made_grid("mixed", 4, {}, 1);
    grid.cell_fields = {cell_numbers(grid)};
    const Grid faces = as_polyhedra(grid, Listed::ascending, 2);
    const Array whole = find_field(grid, "number").value().values, same = find_field(faces, "number").value().values;
    ASSERT_EQ(whole.tuples(), same.tuples());
    for (std::size_t i = 0; i < whole.tuples(); ++i) ASSERT_NEAR(whole.at(i), same.at(i), 1e-9);
}

TEST(PolyhedralGrids, HaveTheBoundaryOfTheirFaces) {
    const Grid grid = octree_grid({.seed = 3, .moved = 0});
    EXPECT_NEAR(area(boundary_of(grid).value()), 6 * 36, 1e-9);
    const GridReport report = survey(grid).value();
    EXPECT_EQ(report.cells_by_type.count(42), 1u);
    EXPECT_EQ(report.upper[0], 6);
    EXPECT_EQ(report.cells_left_out, 0u);
}

} // namespace
} // namespace isotet::test
