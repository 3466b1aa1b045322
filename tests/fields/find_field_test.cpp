// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which field a name means, and what happens when it means none.
#include <cmath>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>

namespace {

using namespace isotet;

template <class T>
Field field(const std::string& name, std::vector<T> values, std::size_t components = 1) {
    return {name, Array::own(std::move(values), components)};
}

/// One tet.
Grid tet(std::vector<Field> point_fields, std::vector<Field> cell_fields = {}) {
    Grid grid;
    grid.points = Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3}, 3);
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, 3});
    grid.point_fields = std::move(point_fields);
    grid.cell_fields = std::move(cell_fields);
    return grid;
}

template <class T = float>
std::vector<T> values_of(const Grid& grid, std::string_view name) {
    const PointField found = find_field(grid, name).value();
    EXPECT_EQ(found.values.type(), scalar_type_of<T>());
    EXPECT_EQ(found.values.components(), 1u);
    EXPECT_EQ(found.name, name);
    const auto all = found.values.as<T>();
    return {all.begin(), all.end()};
}

void expect_error(const Grid& grid, std::string_view name, const std::string& part,
                  ErrorCode code = ErrorCode::invalid_argument) {
    const auto found = find_field(grid, name);
    ASSERT_FALSE(found);
    EXPECT_EQ(found.error().code, code);
    EXPECT_NE(found.error().message.find(part), std::string::npos) << found.error().message;
}

TEST(FindField, HandsOutAScalarPointFieldItself) {
    const Grid grid = tet({field<std::int16_t>("n", {1, 2, 3, 4})});
    const PointField found = find_field(grid, "n").value();
    EXPECT_EQ(found.values.data(), grid.point_fields[0].values.data());
    EXPECT_FALSE(found.averaged);
    EXPECT_TRUE(found.note.empty());
}

TEST(FindField, TakesComponentsInTheirOwnType) {
    const Grid grid = tet({field<std::int64_t>("v", {1, 2, 3, 4, 5, 6, 7, 8, 9007199254740993, 10, 11, 12}, 3)});
    EXPECT_EQ(values_of<std::int64_t>(grid, "v:x"), (std::vector<std::int64_t>{1, 4, 7, 10}));
    EXPECT_EQ(values_of<std::int64_t>(grid, "v:z"), (std::vector<std::int64_t>{3, 6, 9007199254740993, 12}));
    EXPECT_EQ(values_of<std::int64_t>(grid, "v:1"), (std::vector<std::int64_t>{2, 5, 8, 11}));
}

TEST(FindField, TakesComponentsOfTensorsByName) {
    std::vector<double> six, nine;
    for (int i = 0; i < 24; ++i) six.push_back(i);
    for (int i = 0; i < 36; ++i) nine.push_back(i);
    const Grid grid =
        tet({field<double>("s", six, 6), field<double>("t", nine, 9), field<double>("v", {0, 1, 2, 3}, 1)});
    const auto first = [&](const char* name) { return values_of<double>(grid, name).at(0); };
    const char* const of_six[] = {"s:xx", "s:yy", "s:zz", "s:xy", "s:yz", "s:xz"};
    const char* const of_nine[] = {"t:XX", "t:XY", "t:XZ", "t:YX", "t:YY", "t:YZ", "t:ZX", "t:ZY", "t:ZZ"};
    for (int i = 0; i < 6; ++i) EXPECT_EQ(first(of_six[i]), i) << of_six[i];
    for (int i = 0; i < 9; ++i) EXPECT_EQ(first(of_nine[i]), i) << of_nine[i];
    EXPECT_EQ(first("s:zx"), 5);
    EXPECT_EQ(first("2*s:xz + t:yx"), 13);
    for (const char* name : {"s:xX", "s:xw", "v:xx", "2*v:xx"}) EXPECT_FALSE(find_field(grid, name)) << name;
}

TEST(FindField, TakesMagnitudesWithoutOverflow) {
    const Grid grid = tet({field<double>("v", {3, 4, 0, 0, -1.5e248, 2e248, 6e-200, 8e-200}, 2)});
    const auto magnitudes = values_of<double>(grid, "v:mag");
    EXPECT_EQ(magnitudes[0], 5);
    EXPECT_EQ(magnitudes[1], 0);
    EXPECT_DOUBLE_EQ(magnitudes[2], 2.5e248);
    EXPECT_DOUBLE_EQ(magnitudes[3], 1e-199);
    EXPECT_EQ(values_of(tet({field<float>("p", {-1, 2, -3, 4})}), "p:mag"), (std::vector<float>{1, 2, 3, 4}));
}

TEST(FindField, PrefersAWholeNameWithAColon) {
    const Grid grid = tet({field<float>("v", {0, 0, 0, 0, 0, 0, 0, 0}, 2), field<float>("v:x", {1, 2, 3, 4})});
    EXPECT_EQ(values_of(grid, "v:x"), (std::vector<float>{1, 2, 3, 4}));
    // Even when the whole name is that of a cell field.
    const Grid mixed = tet({field<float>("v", {0, 0, 0, 0, 0, 0, 0, 0}, 2)}, {field<float>("v:x", {5})});
    EXPECT_EQ(values_of(mixed, "v:x"), (std::vector<float>{5, 5, 5, 5}));
}

TEST(FindField, TakesThePointFieldOfTwoWithOneNameAndSaysSo) {
    const Grid grid = tet({field<float>("p", {1, 2, 3, 4})}, {field<float>("p", {9})});
    const PointField points = find_field(grid, "p").value();
    EXPECT_FALSE(points.averaged);
    EXPECT_EQ(points.note, "'p' is both a point field and a cell field; the point field is taken");
    const PointField cells = find_field(grid, "p", {.prefer = Association::cell}).value();
    EXPECT_TRUE(cells.averaged);
    EXPECT_EQ(cells.values.at(2), 9);
    EXPECT_TRUE(cells.note.empty());
}

TEST(FindField, TakesThePointFieldWhenACellFieldIsPreferredButMissing) {
    EXPECT_FALSE(
        find_field(tet({field<float>("p", {1, 2, 3, 4})}), "p", {.prefer = Association::cell}).value().averaged);
}

TEST(FindField, TakesCoordinatesWhenNoFieldHasTheName) {
    EXPECT_EQ(values_of(tet({}), "z"), (std::vector<float>{0, 0, 0, 3}));
    EXPECT_EQ(values_of(tet({field<float>("p", {1, 2, 3, 4})}), "x"), (std::vector<float>{0, 1, 0, 0}));
    EXPECT_EQ(values_of(tet({field<float>("y", {1, 2, 3, 4})}), "y"), (std::vector<float>{1, 2, 3, 4}));
}

TEST(FindField, TakesTheOnlyFieldForAnEmptyName) {
    EXPECT_EQ(find_field(tet({field<float>("p", {1, 2, 3, 4})}), "").value().name, "p");
    EXPECT_TRUE(find_field(tet({}, {field<float>("q", {1})}), "").value().averaged);
    EXPECT_FALSE(find_field(tet({field<float>("p", {1, 2, 3, 4})}, {field<float>("p", {1})}), "").value().note.empty());
    expect_error(tet({field<float>("p", {1, 2, 3, 4})}, {field<float>("q", {1})}), "", "the grid has 2: 'p', 'q'");
    expect_error(tet({}), "", "the grid has none");
    expect_error(tet({field<float>("v", {1, 2, 3, 4, 5, 6, 7, 8}, 2)}), "", "the field 'v' has 2 components");
}

TEST(FindField, ListsWhatThereIsNearestFirst) {
    const Grid grid = tet({field<float>("velocity", {1, 2, 3, 4}), field<float>("pressure", {1, 2, 3, 4})},
                          {field<float>("Presure2", {1})});
    expect_error(grid, "presure", "the field is 'presure', but the grid has 'pressure', 'Presure2', 'velocity'");
    expect_error(tet({}), "p", "only the coordinates x, y, z");
    expect_error(grid, "velocity:w", "the field is 'velocity:w'");
}

TEST(FindField, AsksForAComponentAndRefusesOneThatIsNotThere) {
    const Grid grid = tet({field<float>("v", {1, 2, 3, 4, 5, 6, 7, 8}, 2)});
    expect_error(grid, "v", "the field 'v' has 2 components, but one is needed");
    expect_error(grid, "v:z", "component 'z' of the field 'v' is asked for, but it has 2");
    expect_error(grid, "v:2", "component '2'");
    expect_error(grid, "v:99999999999999999999999", "component '99999999999999999999999'");
}

TEST(FindField, RefusesFieldsOfTheWrongLength) {
    expect_error(tet({field<float>("p", {1, 2, 3})}), "p", "point field 'p' has 3 tuples");
    expect_error(tet({}, {field<float>("c", {1, 2})}), "c", "cell field 'c' has 2 tuples");
    expect_error(tet({field<float>("p", {})}), "p", "0 tuples");
}

TEST(FindField, RefusesABrokenGridWhenItNeedsItsCells) {
    Grid grid = tet({}, {field<float>("c", {1})});
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, 7});
    expect_error(grid, "c", "point 7", ErrorCode::invalid_data);
    grid.points = Array::own(std::vector<std::int32_t>(12), 3);
    expect_error(grid, "x", "points are int32", ErrorCode::invalid_data);
}

} // namespace
