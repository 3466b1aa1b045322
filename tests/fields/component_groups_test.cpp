// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Scalars that are components of a vector or tensor: found by their names, as VTK 9.7 groups those of Exodus and CGNS.
#include <cmath>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>

namespace {

using namespace isotet;
using Names = std::vector<std::string>;

Names group_names(const Names& names) {
    Names groups;
    for (const ComponentGroup& group : component_groups(names)) groups.push_back(group.name);
    return groups;
}

Field scalars(const std::string& name, std::vector<float> values) { return {name, Array::own(std::move(values))}; }

/// One tet with a velocity in components, on points and, of other values, on cells.
Grid tet_with_components() {
    Grid grid;
    grid.points = Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0, 3}, 3);
    grid.cells.connectivity = Array::own(std::vector<std::int32_t>{0, 1, 2, 3});
    grid.point_fields = {scalars("p", {1, 2, 3, 4}), scalars("VelocityX", {2, 0, 0, 0}),
                         scalars("VelocityY", {3, 1, 0, 0}), scalars("VelocityZ", {6, 0, 2, 0})};
    return grid;
}

TEST(ComponentGroups, AreNamedByWhatTheirFieldsHaveInCommon) {
    EXPECT_EQ(group_names({"VelocityX", "VelocityY", "VelocityZ"}), Names{"Velocity"});
    EXPECT_EQ(group_names({"p", "disp_x", "disp_y", "disp_z", "vx", "vy", "vz"}), (Names{"disp_", "v"}));
    EXPECT_EQ(group_names({"v:x", "v:y", "v:z"}), Names{"v:"});
    EXPECT_EQ(group_names({"VZ", "p", "VX", "VY"}), Names{"V"}) << "in any order, with others between";
}

TEST(ComponentGroups, TakeSymmetricTensorsInVtksOrderAndFullOnes) {
    const auto symmetric = component_groups({"s_xx", "s_yy", "s_zz", "s_xy", "s_xz", "s_yz"});
    ASSERT_EQ(symmetric.size(), 1u) << "rows of a tensor are no vectors";
    EXPECT_EQ(symmetric[0].name, "s_");
    EXPECT_EQ(symmetric[0].parts, (Names{"s_xx", "s_yy", "s_zz", "s_xy", "s_yz", "s_xz"}));
    const auto full = component_groups({"Fxx", "Fxy", "Fxz", "Fyx", "Fyy", "Fyz", "Fzx", "Fzy", "Fzz"});
    ASSERT_EQ(full.size(), 1u);
    EXPECT_EQ(full[0].name, "F");
    EXPECT_EQ(full[0].parts.size(), 9u);
}

TEST(ComponentGroups, NeedAllComponentsAStemAndAFreeName) {
    EXPECT_EQ(group_names({"x", "y", "z"}), Names{});
    EXPECT_EQ(group_names({"vx", "vy"}), Names{});
    EXPECT_EQ(group_names({"vx", "vy", "vZ"}), Names{}) << "one case";
    EXPECT_EQ(group_names({"vx", "vy", "vz", "v"}), Names{}) << "there is a field of that name";
    EXPECT_EQ(group_names({"stress_1", "stress_2", "stress_3"}), Names{});
    EXPECT_EQ(group_names({}), Names{});
}

TEST(MatchFieldName, TakesGroupsOfComponentsLast) {
    const Names names{"disp_x", "disp_y", "disp_z", "p"};
    for (const char* name : {"disp_", "disp"}) {
        const auto match = match_field_name(name, names);
        ASSERT_TRUE(match) << name;
        EXPECT_EQ(match->field, "disp_");
        EXPECT_EQ(match->parts, (Names{"disp_x", "disp_y", "disp_z"}));
        EXPECT_EQ(match_field_name(std::string(name) + ":mag", names)->component, "mag");
    }
    const auto one = match_field_name("disp:y", names);
    EXPECT_EQ(one->field, "disp_y") << "nothing else is read";
    EXPECT_TRUE(one->parts.empty());
    EXPECT_FALSE(match_field_name("disp:3", names));
    EXPECT_FALSE(match_field_name("dis", names));
    EXPECT_EQ(match_field_name("disp", {"disp", "disp_x", "disp_y", "disp_z"})->parts, Names{}) << "fields come first";
}

TEST(MatchFieldName, FindsOneComponentWithoutTheOthers) {
    for (const auto& [name, field] : {std::pair{"disp:y", "disp_y"},
                                      {"disp:1", "disp_y"},
                                      {"Stress:yz", "StressYZ"},
                                      {"Stress:YZ", "StressYZ"},
                                      {"Stress:4", "StressYZ"},
                                      {"S_:xx", "S_xx"}}) {
        const auto match = match_field_name(name, {"p", field});
        ASSERT_TRUE(match) << name;
        EXPECT_EQ(match->field, field);
        EXPECT_TRUE(match->parts.empty());
    }
    for (const char* name : {"S:x", "S:mag", "S:zz", ":xx", "Str:xx"})
        EXPECT_FALSE(match_field_name(name, {"S_xx", "_xx", "StressX"})) << name;
}

TEST(FindField, TakesTheMagnitudeOfComponents) {
    const Grid grid = tet_with_components();
    const PointField speed = find_field(grid, "Velocity:mag").value();
    EXPECT_EQ(speed.name, "Velocity:mag");
    EXPECT_EQ(speed.values.type(), ScalarType::float32);
    EXPECT_EQ(std::vector<float>(speed.values.as<float>().begin(), speed.values.as<float>().end()),
              (std::vector<float>{7, 1, 2, 0}));
    EXPECT_EQ(find_field(grid, "Velocity:1")->values.data(), grid.point_fields[2].values.data()) << "the scalar itself";
    EXPECT_EQ(find_field(grid, "VelocityX")->values.data(), grid.point_fields[1].values.data());
    EXPECT_NE(find_field(grid, "Velocity").error().message.find("has 3 components"), std::string::npos);
}

TEST(FindField, AveragesComponentsOfCells) {
    Grid grid = tet_with_components();
    grid.point_fields.clear();
    grid.cell_fields = {scalars("u_x", {2}), scalars("u_y", {3}), scalars("u_z", {6})};
    const PointField speed = find_field(grid, "u:mag").value();
    EXPECT_TRUE(speed.averaged);
    EXPECT_EQ(speed.values.at(3), 7);
}

TEST(FindField, RefusesComponentsThatDoNotFitTogether) {
    Grid grid = tet_with_components();
    grid.point_fields[3].values = Array::own(std::vector<float>{1, 2, 3});
    EXPECT_NE(find_field(grid, "Velocity:mag").error().message.find("takes the field 'VelocityZ' for a component"),
              std::string::npos);
    grid = tet_with_components();
    grid.cell_fields = {grid.point_fields.back()};
    grid.point_fields.pop_back();
    EXPECT_NE(find_field(grid, "Velocity:mag").error().message.find("of points and of cells"), std::string::npos);
}

TEST(GatherComponents, PutsThemSideBySideInTheirCommonType) {
    const std::vector<Field> fields{scalars("a", {1, 2}), {"b", Array::own(std::vector<std::int32_t>{3, 4})}};
    const Field both = gather_components(fields, "ab", {"a", "b"}).value();
    EXPECT_EQ(both.values.type(), ScalarType::float64);
    EXPECT_EQ(both.values.components(), 2u);
    EXPECT_EQ(both.values.at(1, 0), 2);
    EXPECT_EQ(both.values.at(1, 1), 4);
    EXPECT_FALSE(gather_components(fields, "ab", {"a", "c"}));
    EXPECT_FALSE(gather_components(fields, "ab", {}));
}

TEST(JoinedFields, AreVectorsOfPackedNamesAndTheOthers) {
    const auto joined = [](const Names& names) {
        Names texts;
        for (const ComponentGroup& field : joined_fields(names))
            texts.push_back(field.name + std::to_string(field.parts.size()));
        return texts;
    };
    EXPECT_EQ(joined({"p", "U:x", "U:y", "U:z", "U:mag", "T"}), (Names{"p1", "U3", "T1"}));
    EXPECT_EQ(joined({"U:z", "p", "U:x", "U:y"}), (Names{"U3", "p1"}));
    EXPECT_EQ(joined({"U:x", "U:y", "U:mag"}), (Names{"U:x1", "U:y1", "U:mag1"})) << "a component is missing";
    EXPECT_EQ(joined({"U", "U:x", "U:y", "U:z"}), (Names{"U1", "U:x1", "U:y1", "U:z1"}))
        << "the name is another field's";
    EXPECT_EQ(joined({"x", "y", "z", "mag"}), (Names{"x1", "y1", "z1", "mag1"}));
    EXPECT_EQ(joined(packed_names_of_vector("a:b")), Names{"a:b3"});
    EXPECT_TRUE(joined({}).empty());
}

} // namespace
