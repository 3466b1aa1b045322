// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Names of fields and cell types.
#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>

namespace {

using namespace isotet;
using Names = std::vector<std::string>;

TEST(MatchFieldName, TakesANameWithColonsWholeFirst) {
    const auto match = match_field_name("gmsh:x", {"gmsh", "gmsh:x"});
    ASSERT_TRUE(match);
    EXPECT_EQ(match->field, "gmsh:x");
    EXPECT_FALSE(match->component);
}

TEST(MatchFieldName, SplitsAtTheLastColonOtherwise) {
    const auto match = match_field_name("gmsh:stress:mag", {"gmsh:stress", "gmsh"});
    ASSERT_TRUE(match);
    EXPECT_EQ(match->field, "gmsh:stress");
    EXPECT_EQ(match->component, "mag");
}

TEST(MatchFieldName, KnowsAxesMagnitudeAndNumbersAsComponents) {
    for (const std::string component : {"x", "y", "z", "mag", "0", "17"})
        EXPECT_TRUE(match_field_name("v:" + component, {"v"})) << component;
    for (const std::string component : {"", "w", "X", "-1", "1.0", "magnitude", " x"})
        EXPECT_FALSE(match_field_name("v:" + component, {"v"})) << component;
}

TEST(MatchFieldName, KnowsComponentsAsSolversCallThem) {
    for (const std::string component : {"DX", "UY", "FLUZ", "D1", "V12", "SXX", "SIXY", "S13", "EPZZ"})
        EXPECT_EQ(match_field_name("v:" + component, {"v"})->component, component);
    for (const std::string component : {"MAX", "dx", "D", "D0", "D-1", "PRIN_1", "LONGX", "VMIS", "1D"})
        EXPECT_FALSE(match_field_name("v:" + component, {"v"})) << component;
}

TEST(MatchFieldName, TakesNamesOfComponentsForAnArray) {
    const Names names{"S:VMIS", "S:TRESCA", "S:P1", "T", "a:b"};
    for (const char* component : {"0", "2", "mag", "y"}) {
        const auto match = match_field_name(std::string("S:") + component, names);
        ASSERT_TRUE(match) << component;
        EXPECT_EQ(match->component, component);
        EXPECT_EQ(match->parts, (Names{"S:VMIS", "S:TRESCA", "S:P1"}));
    }
    EXPECT_EQ(match_field_name("S", names)->parts.size(), 3u);
    EXPECT_EQ(match_field_name("S:VMIS", names)->parts, Names{}) << "fields come first";
    for (const char* name : {"S:3", "S:xy", "a", "a:0", ":0", ""}) EXPECT_FALSE(match_field_name(name, names)) << name;
    const Names six{"C:OPEN", "C:SLIP1", "C:SLIP2", "C:PRESS", "C:SHEAR1", "C:SHEAR2"};
    EXPECT_TRUE(match_field_name("C:3", six));
    EXPECT_FALSE(match_field_name("C:xy", six)) << "no tensor";
}

TEST(MatchFieldName, FindsNothingForOtherNames) {
    EXPECT_FALSE(match_field_name("w", {"v"}));
    EXPECT_FALSE(match_field_name("w:x", {"v"}));
    EXPECT_FALSE(match_field_name(":x", {"v"}));
    EXPECT_FALSE(match_field_name("x", {}));
}

TEST(MatchFieldName, TakesBlanksAndBracketsAsTheyAre) {
    EXPECT_EQ(match_field_name("velocity_liq (m/s):y", {"velocity_liq (m/s)"})->field, "velocity_liq (m/s)");
}

TEST(NearestFirst, SortsByEditDistanceAndKeepsTheOrderOfEquals) {
    EXPECT_EQ(nearest_first("presure", {"velocity", "temperature", "Pressure", "p"}),
              (Names{"Pressure", "temperature", "p", "velocity"}));
    EXPECT_EQ(nearest_first("q", {"c", "a", "b"}), (Names{"c", "a", "b"}));
    EXPECT_EQ(nearest_first("q", {}), Names{});
}

TEST(NearestFirst, BearsNamesOfAnyLengthAndBytes) {
    const std::string long_name(100000, 'a'), odd("\xff\0\n", 3);
    EXPECT_EQ(nearest_first("a", {long_name, odd}), (Names{odd, long_name}));
}

TEST(NameOfCellType, KnowsVtksNumbersAndOthersByNumber) {
    EXPECT_EQ(name_of_cell_type(10), "tetrahedron");
    EXPECT_EQ(name_of_cell_type(7), "polygon");
    EXPECT_EQ(name_of_cell_type(24), "quadratic tetrahedron");
    EXPECT_EQ(name_of_cell_type(42), "polyhedron");
    EXPECT_EQ(name_of_cell_type(81), "Bezier pyramid");
    EXPECT_EQ(name_of_cell_type(97), "cell type 97");
    EXPECT_EQ(name_of_cell_type(17), "cell type 17");
}

} // namespace
