// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <cstring>

#include <gtest/gtest.h>

#include "io/tetgen/read_tetgen.hpp"
#include "readers/sample_bytes.hpp"

namespace isotet::test {
namespace {

const std::string sample_nodes =
    "# points\n5 3 2 1\n\n0 0 0 0 1.5 10 -1\n1 1 0 0 2.5 11 0 # a comment\n2 0 1 0 3.5 12 1\n"
    "3 0 0 1 4.5 13 2\n4 1 1 1 5.5 14 3\n# made by a program\n";
const std::string sample_tets = "2 4 1\n0 0 1 2 3 0.5\n1 1 2 3 4 0.25\n";

ReadResult read_text(const std::string& node_text, const std::string& element_text, const ReadOptions& options = {}) {
    return io::parse_tetgen(node_text, element_text, options, {}).value();
}

std::string tetgen_error(const std::string& node_text, const std::string& element_text) {
    const auto result = io::parse_tetgen(node_text, element_text, {}, {});
    return result ? "no error" : result.error().message;
}

TEST(ReadTetgen, GivesPointsTetsAttributesAndMarkers) {
    const ReadResult result = read_text(sample_nodes, sample_tets);
    const Grid& grid = result.grid;
    EXPECT_EQ(values_of(grid.points), (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}));
    EXPECT_EQ(values_of(grid.cells.connectivity), (std::vector<double>{0, 1, 2, 3, 1, 2, 3, 4}));
    EXPECT_TRUE(grid.cells.types.empty());
    EXPECT_EQ(values_of(find(grid.point_fields, "attribute_0")->values),
              (std::vector<double>{1.5, 2.5, 3.5, 4.5, 5.5}));
    EXPECT_EQ(values_of(find(grid.point_fields, "attribute_1")->values), (std::vector<double>{10, 11, 12, 13, 14}));
    EXPECT_EQ(values_of(find(grid.point_fields, "boundary_marker")->values), (std::vector<double>{-1, 0, 1, 2, 3}));
    EXPECT_EQ(values_of(find(grid.cell_fields, "region_0")->values), (std::vector<double>{0.5, 0.25}));
    EXPECT_TRUE(result.notes.empty());
}

TEST(ReadTetgen, TakesMarkersThatAreNoWholeNumbers) {
    const std::string marked = "4 3 0 1\n0 0 0 0 0.5\n1 1 0 0 1\n2 0 1 0 2\n3 0 0 1 3\n";
    const Array markers = find(read_text(marked, "1 4 0\n0 0 1 2 3\n").grid.point_fields, "boundary_marker")->values;
    EXPECT_EQ(values_of(markers), (std::vector<double>{0.5, 1, 2, 3}));
}

TEST(ReadTetgen, AnnouncesWhatItReads) {
    const FileInfo info = io::inspect_tetgen(sample_nodes, sample_tets, {}).value();
    ASSERT_EQ(info.fields.size(), 4U);
    EXPECT_EQ(info.fields[2].name, "boundary_marker");
    EXPECT_EQ(info.fields[2].type, ScalarType::int32);
    EXPECT_EQ(info.fields[3].association, Association::cell);
}

TEST(ReadTetgen, TakesNumbersFromOneOrFromAnywhere) {
    const std::string from_one = "4 3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n",
                      scattered = "4 3 0 0\n9 0 0 0\n5 1 0 0\n7 0 1 0\n1 0 0 1\n";
    const std::vector<double> expected{0, 1, 2, 3};
    EXPECT_EQ(values_of(read_text(from_one, "1 4 0\n1 1 2 3 4\n").grid.cells.connectivity), expected);
    EXPECT_EQ(values_of(read_text(scattered, "1 4 0\n1 9 5 7 1\n").grid.cells.connectivity), expected);
}

TEST(ReadTetgen, KeepsTetsOfTenNodesAsQuadraticOnes) {
    std::string ten = "10 3 0 0\n";
    for (int i = 0; i < 10; ++i) ten += std::to_string(i) + " 0 0 " + std::to_string(i) + "\n";
    EXPECT_EQ(types_of(read_text(ten, "1 10 0\n0 0 1 2 3 4 5 6 7 8 9\n").grid.cells), std::vector<int>{24});
}

TEST(ReadTetgen, PassesOverColumnsThatTheHeaderDoesNotAnnounce) {
    EXPECT_EQ(read_text("1 3 0 0\n0 1 2 3 99\n", "0 4 0\n").grid.points.tuples(), 1U);
    EXPECT_EQ(read_text("1 3 0 0 points\n0 1 2 3\n", "0 4 0 7\n").grid.points.tuples(), 1U);
    EXPECT_EQ(tetgen_error("1 3 x\n0 1 2 3\n", "0 4 0\n"), "the .node file has a broken first line at line 1 ('x')");
}

TEST(ReadTetgen, TakesCommasAndTabsBetweenNumbers) {
    for (const char* between : {", ", ",", "\t", " , "}) {
        std::string point_text = "# 4 points\n4,3,0,1\n0,0,0,0,7\n1,1,0,0,7\n2,0,1,0,7\n3,0,0,1,8\n",
                    tet_text = "1,4,0\n0,3,2,1,0\n";
        for (std::string* text : {&point_text, &tet_text})
            for (std::size_t at = 0; (at = text->find(',', at)) != std::string::npos; at += std::strlen(between))
                text->replace(at, 1, between);
        const Grid grid = read_text(point_text, tet_text).grid;
        EXPECT_EQ(values_of(grid.points), (std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}));
        EXPECT_EQ(values_of(grid.cells.connectivity), (std::vector<double>{3, 2, 1, 0}));
        EXPECT_EQ(values_of(find(grid.point_fields, "boundary_marker")->values), (std::vector<double>{7, 7, 7, 8}));
    }
}

TEST(ReadTetgen, ReadsOnlyTheFieldsThatAreWanted) {
    ReadOptions options;
    options.point_fields = {"attribute_1"};
    options.cell_fields.emplace();
    const ReadResult result = read_text(sample_nodes, sample_tets, options);
    ASSERT_EQ(result.grid.point_fields.size(), 1U);
    EXPECT_EQ(result.grid.point_fields[0].values.at(4), 14);
    EXPECT_TRUE(result.grid.cell_fields.empty());
}

TEST(ReadTetgen, NotesALastLineWithoutEnd) {
    const ReadResult result = read_text(sample_nodes, sample_tets.substr(0, sample_tets.size() - 2));
    ASSERT_EQ(result.notes.size(), 1U);
    EXPECT_NE(result.notes[0].find(".ele"), std::string::npos);
    EXPECT_TRUE(read_text(sample_nodes + " ", sample_tets + "# made by a program").notes.empty());
}

TEST(ReadTetgenErrors, NameTheValueAndTheRule) {
    EXPECT_EQ(tetgen_error(sample_nodes, "2 4 1\n0 0 1 2 3 0.5\n"),
              "the .ele file states 2 records of 6 numbers, but there is room for 1 at most");
    EXPECT_EQ(tetgen_error(sample_nodes, "2 4 1\n0 0 1 2 3 0.5\n1 1 2 3 4 oops\n"),
              "the .ele file states 2 records, but record 2 is broken or missing at line 3 ('oops')");
    EXPECT_EQ(tetgen_error(sample_nodes, "2 4 0\n0 0 1 2 3\n1 1 2 3\n# and so on\n"),
              "the .ele file states 2 records, but record 2 is broken or missing at line 3 (its end)");
    EXPECT_EQ(tetgen_error(sample_nodes, sample_tets + "3 1 2 3 4 0\n"),
              "the .ele file holds more records than it states, at line 4 ('3')");
    EXPECT_EQ(tetgen_error(sample_nodes, "1 4 0\n0 0 1 2 5\n"),
              "the .ele file has tet 0 with point 5, which is not in the .node file");
    EXPECT_EQ(tetgen_error(sample_nodes, "1 5 0\n0 0 1 2 3 4\n"),
              "the .ele file says 5 nodes a tet, but 4 or 10 is the rule");
    EXPECT_EQ(tetgen_error("1 2 0 0\n1 0 0\n", sample_tets), "the .node file says dimension 2, but 3 is the rule");
    EXPECT_EQ(tetgen_error("-4 3 0 0\n", sample_tets),
              "the .node file states -4 records of 4 numbers, but there is room for 0 at most");
}

} // namespace
} // namespace isotet::test
