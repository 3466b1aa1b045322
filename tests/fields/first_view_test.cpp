// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is shown of a grid when nobody has said: rules one by one. Real files are in tests/jobs/first_choice_test.cpp.
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/first_view.hpp>
#include <isotet/make.hpp>

namespace isotet::test {
namespace {

using At = std::function<double(double x, double y, double z)>;

Grid cube(std::uint64_t side = 5) {
    Grid grid = make_grid({.shape = "kuhn", .side = side}).value();
    grid.point_fields.clear();
    return grid;
}

Array of_points(const Grid& grid, const At& at) {
    std::vector<double> values;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        values.push_back(at(grid.points.at(i, 0), grid.points.at(i, 1), grid.points.at(i, 2)));
    return Array::own(std::move(values));
}

double smooth(double x, double y, double z) { return x + 0.3 * y - 0.2 * z * z; }

/// The same sequence on every machine.
class Noise {
public:
    double operator()() {
        state_ = state_ * 6364136223846793005U + 1442695040888963407U;
        return static_cast<double>(state_ >> 40U);
    }

private:
    std::uint64_t state_ = 1;
};

Array noise(std::size_t count, double scale = 1.1) {
    Noise next;
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) values.push_back(scale * next());
    return Array::own(std::move(values));
}

FirstView view_of(const Grid& grid) { return first_view(grid, describe_fields(grid)); }

TEST(FirstView, PrefersNamesThatPeopleContour) {
    Grid grid = cube();
    grid.point_fields = {{"foo", of_points(grid, smooth)}, {"pressure", of_points(grid, smooth)}};
    EXPECT_EQ(view_of(grid).field, "pressure");
    EXPECT_EQ(view_of(grid).reason, FirstReason::name);
    EXPECT_EQ(view_of(grid).draw, FirstDraw::isosurfaces);
    grid.point_fields.push_back({"AirTemperature", of_points(grid, smooth)});
    EXPECT_EQ(view_of(grid).field, "AirTemperature");
    grid.point_fields.push_back({"alpha.water", of_points(grid, smooth)});
    EXPECT_EQ(view_of(grid).field, "alpha.water");
}

TEST(FirstView, TakesVonMisesStressAsCodeAsterCallsIt) {
    Grid grid = cube();
    for (const char* component : {"PRIN_1", "TRESCA", "VMIS", "TRIAX"})
        grid.point_fields.push_back({std::string("RESU____SIEQ_NOEU:") + component, of_points(grid, smooth)});
    EXPECT_EQ(view_of(grid).field, "RESU____SIEQ_NOEU:VMIS");
    EXPECT_EQ(view_of(grid).reason, FirstReason::name);
}

TEST(FirstView, TakesTensorsWhereNothingElseVaries) {
    Grid grid = cube();
    const auto scaled = [](double by) {
        return [by](double x, double y, double z) { return 1 + by * smooth(x, y, z); };
    };
    double by = 1;
    for (const char* part : {"XX", "YY", "ZZ", "XY", "YZ", "XZ"})
        grid.point_fields.push_back({std::string("Stress") + part, of_points(grid, scaled(by++))});
    EXPECT_EQ(view_of(grid).field, "Stress:mag");
    EXPECT_EQ(view_of(grid).reason, FirstReason::only);
    EXPECT_EQ(view_of(grid).draw, FirstDraw::isosurfaces);
    grid.point_fields.push_back({"foo", of_points(grid, smooth)});
    EXPECT_EQ(view_of(grid).field, "foo");
    grid.point_fields = {
        {"stress", gather_components(grid.point_fields, "stress",
                                     {"StressXX", "StressYY", "StressZZ", "StressXY", "StressYZ", "StressXZ"})
                       .value()
                       .values}};
    EXPECT_EQ(view_of(grid).field, "stress:mag");
}

TEST(FirstView, ShowsNothingOfLines) {
    Grid grid = cube();
    grid.point_fields = {{"T", of_points(grid, smooth)}};
    grid.cells = {};
    grid.cells.types = Array::own(std::vector<std::uint8_t>{3, 3, 1});
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 2, 4, 5});
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 1, 2, 3});
    EXPECT_TRUE(view_of(grid).empty);
    EXPECT_EQ(view_of(grid).draw, FirstDraw::boundary);
    EXPECT_EQ(view_of(grid).field, "");
    EXPECT_FALSE(view_of(cube()).empty);
}

TEST(FirstView, TakesWhatTheFileMarksBeforeNames) {
    Grid grid = cube();
    grid.point_fields = {{"T", of_points(grid, smooth)}, {"foo", of_points(grid, smooth)}};
    std::vector<FieldInfo> fields = describe_fields(grid);
    fields[1].active = true;
    EXPECT_EQ(first_view(grid, fields).field, "foo");
    EXPECT_EQ(first_view(grid, fields).reason, FirstReason::marked);
    grid.point_fields[1].values = of_points(grid, [](double, double, double) { return 3; });
    EXPECT_EQ(first_view(grid, fields).field, "T") << "constant fields lose, marked or not";
}

TEST(FirstView, NeverTakesBookkeeping) {
    for (const char* name :
         {"vtkOriginalCellIds", "GLOBAL_IDS_POINTS", "GlobalElementID", "id_node", "nodal_weights", "elementCenter",
          "barycenter", "Element_Size_Field_Node", "flux-err", "aux_elem", "CellId", "CartesianCoordinate", "procRank",
          "owner", "Normals", "cell_volume", "PointIDs", "pressure_error"}) {
        Grid grid = cube();
        grid.point_fields = {{name, of_points(grid, smooth)}};
        EXPECT_EQ(view_of(grid).draw, FirstDraw::boundary) << name;
        EXPECT_TRUE(view_of(grid).field.empty()) << name;
        grid.point_fields.push_back({"q17", of_points(grid, smooth)});
        EXPECT_EQ(view_of(grid).field, "q17") << name;
    }
}

TEST(FirstView, PutsDerivativesBehindWhatTheyAreOf) {
    Grid grid = cube();
    grid.point_fields = {{"dtemperature_dt", of_points(grid, smooth)}, {"temperature", of_points(grid, smooth)}};
    EXPECT_EQ(view_of(grid).field, "temperature");
}

TEST(FirstView, CountsVectorsByTheirMagnitude) {
    Grid grid = cube();
    std::vector<double> vectors;
    for (std::size_t i = 0; i < grid.points.tuples(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis) vectors.push_back(grid.points.at(i, axis));
    grid.point_fields = {{"U", Array::own(std::move(vectors), 3)}};
    EXPECT_EQ(view_of(grid).field, "U:mag");
    grid.point_fields = {{"VelocityX", of_points(grid, smooth)},
                         {"VelocityY", of_points(grid, smooth)},
                         {"VelocityZ", of_points(grid, smooth)},
                         {"foo", of_points(grid, smooth)}};
    EXPECT_EQ(view_of(grid).field, "Velocity:mag");
}

TEST(FirstView, TakesASmoothFieldBeforeNoise) {
    Grid grid = cube();
    grid.point_fields = {{"a", noise(grid.points.tuples())}, {"b", of_points(grid, smooth)}};
    EXPECT_EQ(view_of(grid).field, "b");
    grid.point_fields.pop_back();
    EXPECT_EQ(view_of(grid).field, "a");
    EXPECT_EQ(view_of(grid).draw, FirstDraw::field_on_boundary);
    EXPECT_TRUE(view_of(grid).rough);
}

TEST(FirstView, ColoursTheBoundaryByCellValuesThatJump) {
    Grid grid = cube();
    grid.cell_fields = {{"PORO", noise(grid.cells.count())}};
    EXPECT_EQ(view_of(grid).field, "PORO");
    EXPECT_EQ(view_of(grid).draw, FirstDraw::field_on_boundary);
    std::vector<double> smooth_values;
    for (std::size_t cell = 0; cell < grid.cells.count(); ++cell)
        smooth_values.push_back(grid.points.at(static_cast<std::size_t>(grid.cells.connectivity.at(4 * cell)), 0));
    grid.cell_fields = {{"PORO", Array::own(std::move(smooth_values))}};
    EXPECT_EQ(view_of(grid).draw, FirstDraw::isosurfaces);
}

TEST(FirstView, ColoursTheBoundaryByRegionsWhereNothingElseVaries) {
    Grid grid = cube();
    std::vector<std::int32_t> halves(grid.cells.count(), 1), ids;
    for (std::size_t cell = 0; cell < halves.size(); ++cell) {
        if (cell < halves.size() / 2) halves[cell] = 2;
        ids.push_back(static_cast<std::int32_t>(cell));
    }
    grid.cell_fields = {{"number", Array::own(std::move(ids))}, {"material", Array::own(std::move(halves))}};
    EXPECT_EQ(view_of(grid).field, "material");
    EXPECT_EQ(view_of(grid).draw, FirstDraw::regions_on_boundary);
    grid.point_fields = {{"foo", of_points(grid, smooth)}};
    EXPECT_EQ(view_of(grid).field, "foo") << "a field that varies comes first";
}

TEST(FirstView, ShowsTheGridWhereNothingVaries) {
    Grid grid = cube();
    EXPECT_EQ(view_of(grid).draw, FirstDraw::boundary);
    grid.point_fields = {{"T", of_points(grid, [](double x, double, double) { return 300 + 1e-9 * x; })},
                         {"p", of_points(grid, [](double, double, double) { return std::nan(""); })}};
    EXPECT_EQ(view_of(grid).draw, FirstDraw::boundary) << "roundings are no variation";
    EXPECT_EQ(view_of(grid).reason, FirstReason::nothing);
}

TEST(FirstView, PassesOverFieldsWithoutAValueInACellWithAVolume) {
    Grid grid;
    grid.points = Array::own(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 2, 0, 0, 3, 0, 0, 3, 1, 0}, 3);
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 2, 3, 4, 5, 6});
    grid.cells.offsets = Array::own(std::vector<std::int64_t>{0, 4, 7});
    grid.cells.types = Array::own(std::vector<std::uint8_t>{10, 5});
    const double none = std::numeric_limits<double>::quiet_NaN();
    grid.point_fields = {{"temperature", Array::own(std::vector<double>{none, none, none, none, 1, 5, 9})},
                         {"q", Array::own(std::vector<double>{1, 5, 9, 2, none, none, none})}};
    EXPECT_EQ(first_view(grid, describe_fields(grid)).field, "q");
    EXPECT_FALSE(field_varies(grid, "temperature"));
}

TEST(FirstView, TakesWhatVariesAtTheBoundaryAloneLast) {
    Grid grid = cube();
    grid.point_fields = {{"p", of_points(grid, smooth)}};
    grid.cell_fields = {{"p", Array::own(std::vector<double>(grid.cells.count(), 3))}};
    const FirstView alone = first_view(grid, describe_fields(grid));
    EXPECT_EQ(alone.field, "p");
    EXPECT_TRUE(alone.walls);
    EXPECT_FALSE(field_varies(grid, "p"));
    grid.point_fields.push_back({"q", of_points(grid, smooth)});
    const FirstView view = first_view(grid, describe_fields(grid));
    EXPECT_EQ(view.field, "q") << "though p has the better name";
    EXPECT_FALSE(view.walls);
    EXPECT_TRUE(field_varies(grid, "q"));
    std::vector<double> growing;
    for (std::size_t cell = 0; cell < grid.cells.count(); ++cell) growing.push_back(static_cast<double>(cell));
    grid.cell_fields[0].values = Array::own(std::move(growing));
    EXPECT_EQ(first_view(grid, describe_fields(grid)).field, "p");
    EXPECT_TRUE(field_varies(grid, "p"));
}

TEST(FirstView, PassesOverValuesBeyondAllMeasure) {
    Grid grid = cube();
    grid.point_fields = {{"T", of_points(grid, [](double x, double, double) { return 1e101 * x; })},
                         {"foo", of_points(grid, smooth)}};
    EXPECT_EQ(view_of(grid).field, "foo");
}

TEST(FirstView, ColoursTheBoundaryOfAGridThatIsOneCellThick) {
    Grid grid = make_grid({.shape = "hex", .side = 16}).value();
    std::vector<std::int64_t> corners;
    for (std::size_t cell = 0; cell < 256; ++cell) // the lowest layer
        for (std::size_t i = 0; i < 8; ++i)
            corners.push_back(static_cast<std::int64_t>(grid.cells.connectivity.at(8 * cell + i)));
    grid.cells.connectivity = Array::own(std::move(corners));
    grid.point_fields = {{"T", of_points(grid, smooth)}};
    EXPECT_EQ(view_of(grid).draw, FirstDraw::field_on_boundary);
    EXPECT_EQ(view_of(grid).field, "T");
    EXPECT_FALSE(view_of(grid).rough);
}

TEST(FirstView, DoesNotTakeACubeForOneThatIsOneCellThick) {
    for (const auto& [shape, side] : {std::pair{"kuhn", 64u}, {"kuhn", 32u}, {"hex", 64u}}) {
        const Grid grid = make_grid({.shape = shape, .side = side, .fields = {"gyroid"}}).value();
        EXPECT_EQ(view_of(grid).draw, FirstDraw::isosurfaces) << shape << " of " << side;
    }
}

TEST(FirstView, DoesNotTakeCoarseGridsForNoise) {
    Grid grid = cube(2);
    grid.point_fields = {{"foo", of_points(grid, smooth)}};
    EXPECT_EQ(view_of(grid).draw, FirstDraw::isosurfaces);
}

TEST(FirstView, BearsBrokenCells) {
    Grid grid = cube();
    grid.point_fields = {{"T", of_points(grid, smooth)}};
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, -5, 1000000, 3, 4, 5});
    EXPECT_EQ(view_of(grid).field, "T");
    grid.cells.connectivity = {};
    EXPECT_EQ(view_of(grid).field, "T");
    grid.point_fields[0].values = Array::own(std::vector<double>{1, 2});
    EXPECT_EQ(view_of(grid).field, "T") << "lengths are checked by find_field()";
    EXPECT_EQ(view_of(Grid{}).draw, FirstDraw::boundary);
}

TEST(FirstCandidates, HaveNamesWithoutTheirUnitsInBrackets) {
    for (const char* name : {"T [K]", "T (K)", "T [\u00b0C]", "p(Pa)", "Mach Number", "Head [m]", "Salinity"}) {
        const auto candidates = first_candidates({{name, Association::point, ScalarType::float32, 1}});
        ASSERT_EQ(candidates.size(), 1u) << name;
        EXPECT_EQ(candidates[0].reason, FirstReason::name) << name;
    }
    EXPECT_TRUE(first_candidates({{"machine_id", Association::point, ScalarType::float32, 1}}).empty());
    for (const char* name : {"[K]", "(x)", "foo [1]"}) {
        const auto candidates = first_candidates({{name, Association::point, ScalarType::float32, 1}});
        ASSERT_EQ(candidates.size(), 1u) << name;
        EXPECT_EQ(candidates[0].reason, FirstReason::variation) << name;
    }
}

TEST(FirstCandidates, AreInTheOrderInWhichTheyAreLookedAt) {
    const std::vector<FieldInfo> fields{
        {"foo", Association::point, ScalarType::float32, 1}, {"T", Association::cell, ScalarType::float32, 1},
        {"T", Association::point, ScalarType::float32, 1},   {"S", Association::point, ScalarType::float32, 6},
        {"id", Association::point, ScalarType::int32, 1},    {"w", Association::point, ScalarType::float32, 3, true}};
    const auto candidates = first_candidates(fields);
    ASSERT_EQ(candidates.size(), 5u) << "no number";
    EXPECT_EQ(candidates[0].name, "w:mag");
    EXPECT_EQ(candidates[1].association, Association::point);
    EXPECT_EQ(candidates[2].association, Association::cell);
    EXPECT_EQ(candidates[3].name, "foo");
    EXPECT_EQ(candidates[4].name, "S:mag") << "a tensor";
}

} // namespace
} // namespace isotet::test
