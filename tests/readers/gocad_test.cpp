// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "io/gocad/read_gocad.hpp"
#include "readers/gocad_sample.hpp"
#include "readers/sample_bytes.hpp"

namespace isotet::test {
namespace {

ReadResult read_text(const std::string& text, const ReadOptions& options = {}) {
    return io::parse_gocad(text, options, {}).value();
}

std::string gocad_error(const std::string& text) {
    const auto result = io::parse_gocad(text, {}, {});
    return result ? "no error" : result.error().message;
}

TEST(ReadGocad, GivesDepthAsNegativeElevation) {
    const ReadResult result = read_text(gocad_sample);
    EXPECT_EQ(values_of(result.grid.points),
              (std::vector<double>{0, 0, -100.5, 1, 0, -100, 0, 1, -100, 0, 0, -99, 1, 1, -99}));
    EXPECT_EQ(values_of(read_text(replaced(gocad_sample, "Depth", "Elevation")).grid.points)[2], 100.5);
}

TEST(ReadGocad, WeldsAtomsToTheirPoints) {
    const ReadResult result = read_text(gocad_sample);
    EXPECT_EQ(values_of(result.grid.cells.connectivity), (std::vector<double>{0, 1, 2, 3, 1, 2, 3, 4, 4, 0, 1, 2}));
    EXPECT_TRUE(check(result.grid));
}

TEST(ReadGocad, GivesPropertiesWithNoDataAsNaN) {
    const ReadResult result = read_text(gocad_sample);
    const std::vector<double> rock = values_of(find(result.grid.point_fields, "rock type")->values);
    ASSERT_EQ(rock.size(), 5U);
    EXPECT_EQ(rock[0], 1);
    EXPECT_EQ(rock[1], 2);
    EXPECT_TRUE(std::isnan(rock[2])) << "a VRTX has no properties";
    EXPECT_TRUE(std::isnan(rock[3])) << "-99999 is no data";
    EXPECT_EQ(rock[4], 4);
    const Field* velocity = find(result.grid.point_fields, "velocity");
    EXPECT_EQ(velocity->values.components(), 3U);
    EXPECT_TRUE(std::isnan(velocity->values.at(1, 1)));
    EXPECT_EQ(velocity->values.at(1, 2), 1);
    EXPECT_EQ(velocity->values.at(4, 2), 4);
    const std::vector<double> porosity = values_of(find(result.grid.cell_fields, "porosity")->values);
    EXPECT_EQ(porosity[0], 0.25);
    EXPECT_TRUE(std::isnan(porosity[1]));
    EXPECT_EQ(porosity[2], 0.5);
}

TEST(ReadGocad, NumbersVolumesInTheOrderOfTheFile) {
    const ReadResult result = read_text(gocad_sample);
    const Field* volume = find(result.grid.cell_fields, "tvolume");
    EXPECT_EQ(volume->values.type(), ScalarType::int32);
    EXPECT_EQ(values_of(volume->values), (std::vector<double>{0, 1, 1}));
}

TEST(ReadGocad, NotesWhatItChanged) {
    const ReadResult result = read_text(gocad_sample);
    ASSERT_EQ(result.notes.size(), 3U);
    EXPECT_NE(result.notes[0].find("depth"), std::string::npos);
    EXPECT_EQ(result.notes[1], "4 atoms are the points that they refer to");
    EXPECT_EQ(result.notes[2], "properties of atoms that differ from those of their points are dropped: 1");
}

TEST(ReadGocad, NotesLinesThatItDoesNotRead) {
    const ReadResult result = read_text(replaced(gocad_sample, "TETRA 5 9", "TETRAS 1 2 3 4\nTETRA 5 9"));
    std::string said;
    for (const LeftOut& item : result.info.left_out) said += item.what + " " + item.name + ": " + item.reason + "\n";
    EXPECT_EQ(said, "line TETRAS: the keyword is not known\n"
                    "line MODEL: surfaces between volumes are not read\n"
                    "line SURFACE: surfaces between volumes are not read\n"
                    "line TFACE: surfaces between volumes are not read\n"
                    "line TRGL: surfaces between volumes are not read\n");
    std::string many;
    for (int i = 0; i < 30; ++i) many += "WORD" + std::to_string(i) + "\n";
    const ReadResult others = read_text(replaced(gocad_sample, "MODEL\n", many.c_str()));
    EXPECT_EQ(others.info.left_out.size(), 17u);
    EXPECT_EQ(others.info.left_out.back().reason, "17 lines have more unknown keywords");
}

TEST(ReadGocad, AnnouncesWhatItReads) {
    const FileInfo info = io::inspect_gocad(gocad_sample, {}).value();
    ASSERT_EQ(info.fields.size(), 4U);
    EXPECT_EQ(info.fields[0].name, "rock type");
    EXPECT_EQ(info.fields[1].components, 3U);
    EXPECT_EQ(info.fields[2].name, "porosity");
    EXPECT_EQ(info.fields[3].name, "tvolume");
    EXPECT_EQ(read_text(gocad_sample).info.regions.size(), 2U);
    ASSERT_EQ(info.regions.size(), 2U);
    EXPECT_EQ(info.regions[0].name, "lower");
    EXPECT_EQ(info.regions[1].field, "tvolume");
    EXPECT_EQ(info.regions[1].number, 1);
    EXPECT_EQ(info.regions[1].name, "upper");
}

TEST(ReadGocad, NamesMayHaveBlanksWithOrWithoutQuotationMarks) {
    const std::string text = replaced(replaced(gocad_sample, "TVOLUME lower", "TVOLUME  lower part 2\t\r"),
                                      "TVOLUME upper", "TVOLUME \"upper part\" 1");
    const FileInfo info = io::inspect_gocad(text, {}).value();
    ASSERT_EQ(info.regions.size(), 2U);
    EXPECT_EQ(info.regions[0].name, "lower part 2");
    EXPECT_EQ(info.regions[1].name, "upper part");
    EXPECT_EQ(values_of(find(read_text(text).grid.cell_fields, "tvolume")->values), (std::vector<double>{0, 1, 1}));
}

TEST(ReadGocad, ReadsOnlyTheFieldsThatAreWanted) {
    ReadOptions options;
    options.point_fields = {"velocity"};
    options.cell_fields = {"porosity"};
    const ReadResult result = read_text(gocad_sample, options);
    ASSERT_EQ(result.grid.point_fields.size(), 1U);
    EXPECT_EQ(result.grid.point_fields[0].values.at(0, 0), 0);
    EXPECT_EQ(result.grid.point_fields[0].values.at(4, 0), 4);
    ASSERT_EQ(result.grid.cell_fields.size(), 1U);
    EXPECT_EQ(result.grid.cell_fields[0].name, "porosity");
}

TEST(ReadGocad, FollowsAtomsThatReferForward) {
    const std::string text =
        "GOCAD TSolid 1\nTVOLUME a\nATOM 1 2\nATOM 2 3\nVRTX 3 0 0 0\nVRTX 4 1 0 0\nVRTX 5 0 1 0\nVRTX 6 0 0 1\n"
        "TETRA 1 4 5 6\nEND\n";
    EXPECT_EQ(values_of(read_text(text).grid.cells.connectivity), (std::vector<double>{0, 1, 2, 3}));
}

TEST(ReadGocadErrors, NameTheValueAndTheRule) {
    EXPECT_EQ(gocad_error(replaced(gocad_sample, "TETRA 8 1 2 3", "TETRA 8 1 2 33")),
              "TETRA: number 3 (from 1) has vertex 33, which is not in the file");
    EXPECT_EQ(gocad_error(replaced(gocad_sample, "ATOM 9 7", "ATOM 9 9")),
              "ATOM: 9 refers to 9, which leads to no vertex");
    EXPECT_EQ(gocad_error(replaced(gocad_sample, "ATOM 9 7", "ATOM 9 70")),
              "ATOM: 9 refers to 70, which leads to no vertex");
    EXPECT_EQ(gocad_error(replaced(gocad_sample, "PVRTX 8 1 1 99", "PVRTX 1 1 1 99")),
              "vertex 1 occurs twice, but numbers must be unique");
    EXPECT_EQ(gocad_error(replaced(gocad_sample, "TETRA 8 1 2 3 0.5", "TETRA 8 1 2")),
              "TETRA: has a broken line, at line 37 (its end)");
    EXPECT_EQ(gocad_error(replaced(gocad_sample, "ZPOSITIVE Depth", "ZPOSITIVE Sideways")),
              "ZPOSITIVE: is 'Sideways', but Elevation or Depth is the rule");
    EXPECT_EQ(gocad_error("GOCAD TSurf 1\nEND\n"),
              "does not begin with GOCAD TSolid, but 'GOCAD TSurf 1\\x0aEND\\x0a'");
}

TEST(ReadGocad, WithoutEndIsNotedWhereTheRestIsWhole) {
    const std::string text = gocad_sample;
    const std::string without = text.substr(0, text.find("MODEL"));
    const auto result = io::parse_gocad(without, {}, {});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), io::parse_gocad(text, {}, {}).value().grid.cells.count());
    EXPECT_TRUE(std::ranges::any_of(
        result->notes, [](const std::string& note) { return note.find("has no END") != std::string::npos; }));
    EXPECT_EQ(gocad_error(without.substr(0, without.size() - 1)), "has no END: the file is cut short");
    EXPECT_EQ(gocad_error(text.substr(0, text.rfind("END"))), "has no END: the file is cut short") << "in a surface";
    EXPECT_EQ(gocad_error(text.substr(0, text.find("TETRA"))), "has no END: the file is cut short");
}

} // namespace
} // namespace isotet::test
