// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Medit files of every kind give the grid that was written into them.
#include <gtest/gtest.h>

#include "io/own/read_medit.hpp"
#include "readers/medit_sample.hpp"
#include "readers/sample_bytes.hpp"

namespace isotet::test {
namespace {

class ReadMedit : public testing::TestWithParam<MeditVariant> {};

TEST_P(ReadMedit, GivesPointsCellsAndReferences) {
    const ReadResult result = io::parse_medit(medit_sample(GetParam()), std::nullopt, {}, {}).value();
    const Grid& grid = result.grid;
    EXPECT_EQ(grid.points.type(), GetParam().version == 1 ? ScalarType::float32 : ScalarType::float64);
    EXPECT_EQ(values_of(grid.points), cube_points);
    EXPECT_EQ(types_of(grid.cells), cube_types);
    EXPECT_EQ(values_of(grid.cells.connectivity), cube_connectivity());
    EXPECT_EQ(values_of(find(grid.point_fields, "medit:ref")->values),
              (std::vector<double>{10, 11, 12, 13, 14, 15, 16, 17, 18}));
    EXPECT_EQ(values_of(find(grid.cell_fields, "medit:ref")->values), (std::vector<double>{1, 2, 3, 4, 5}));
    EXPECT_TRUE(result.notes.empty());
    EXPECT_TRUE(check(grid));
}

TEST_P(ReadMedit, GivesTheFieldsOfTheSolutionBeside) {
    const std::string mesh = medit_sample(GetParam()), solution = medit_solution_sample(GetParam());
    const ReadResult result = io::parse_medit(mesh, solution, {}, {}).value();
    const Field* scalar = find(result.grid.point_fields, "sol");
    const Field* vector = find(result.grid.point_fields, "sol_1");
    const Field* tensor = find(result.grid.point_fields, "sol_2");
    ASSERT_TRUE(scalar && vector && tensor);
    EXPECT_EQ(vector->values.components(), 3U);
    EXPECT_EQ(tensor->values.components(), 6U);
    for (std::size_t n = 0; n < 9; ++n) {
        const auto value = static_cast<double>(n);
        EXPECT_EQ(scalar->values.at(n), value);
        EXPECT_EQ(vector->values.at(n, 1), value + 0.25);
        EXPECT_EQ(tensor->values.at(n, 5), value + 5);
    }
}

TEST_P(ReadMedit, AnnouncesWhatItReads) {
    const std::string mesh = medit_sample(GetParam()), solution = medit_solution_sample(GetParam());
    const FileInfo info = io::inspect_medit(mesh, solution, {}).value();
    const ReadResult result = io::parse_medit(mesh, solution, {}, {}).value();
    ASSERT_EQ(info.fields.size(), result.grid.point_fields.size() + result.grid.cell_fields.size());
    for (const FieldInfo& field : info.fields) {
        const bool point = field.association == Association::point;
        const Field* read = find(point ? result.grid.point_fields : result.grid.cell_fields, field.name);
        ASSERT_NE(read, nullptr) << field.name;
        EXPECT_EQ(read->values.type(), field.type) << field.name;
        EXPECT_EQ(read->values.components(), field.components) << field.name;
    }
}

TEST_P(ReadMedit, PassesOverFieldsThatNobodyWants) {
    ReadOptions options;
    options.point_fields = {"sol_1"};
    options.cell_fields.emplace();
    const ReadResult result =
        io::parse_medit(medit_sample(GetParam()), medit_solution_sample(GetParam()), options, {}).value();
    ASSERT_EQ(result.grid.point_fields.size(), 1U);
    EXPECT_EQ(result.grid.point_fields[0].values.at(8, 2), 8.5);
    EXPECT_TRUE(result.grid.cell_fields.empty());
}

INSTANTIATE_TEST_SUITE_P(EveryVariant, ReadMedit, testing::ValuesIn(medit_variants()),
                         [](const auto& variant) { return name_of(variant.param); });

std::string medit_error(std::string_view mesh, std::optional<std::string_view> solution = std::nullopt) {
    const auto result = io::parse_medit(mesh, solution, {}, {});
    return result ? "no error" : result.error().message;
}

const std::string head = "MeshVersionFormatted 2 Dimension 3 Vertices 4  0 0 0 1  1 0 0 1  0 1 0 1  0 0 1 1 ";

TEST(ReadMeditText, NeedsNoLineEnds) {
    const ReadResult result = io::parse_medit(head + "Tetrahedra 1 1 2 3 4 5 End", std::nullopt, {}, {}).value();
    EXPECT_EQ(values_of(result.grid.cells.connectivity), (std::vector<double>{0, 1, 2, 3}));
    EXPECT_TRUE(result.grid.cells.types.empty());
}

TEST(ReadMeditText, MayHaveCellsBeforeVertices) {
    const ReadResult result = io::parse_medit("MeshVersionFormatted 2 Dimension 3 Tetrahedra 1 1 2 3 4 5 Vertices 4  0 "
                                              "0 0 1  1 0 0 1  0 1 0 1  0 0 1 1 End",
                                              std::nullopt, {}, {})
                                  .value();
    EXPECT_TRUE(check(result.grid));
}

TEST(ReadMeditText, WithoutEndIsReadWithANote) {
    const ReadResult result = io::parse_medit(head + "Tetrahedra 1 1 2 3 4 5", std::nullopt, {}, {}).value();
    ASSERT_EQ(result.notes.size(), 1U);
    EXPECT_NE(result.notes[0].find("End"), std::string::npos);
}

TEST(ReadMeditText, OfTwoDimensionsGetsZeroForZ) {
    const ReadResult result =
        io::parse_medit("MeshVersionFormatted 2 Dimension 2 Vertices 3 1 2 0 3 4 0 5 6 0 Triangles 1 1 2 3 0 End",
                        std::nullopt, {}, {})
            .value();
    EXPECT_EQ(values_of(result.grid.points), (std::vector<double>{1, 2, 0, 3, 4, 0, 5, 6, 0}));
}

TEST(ReadMeditErrors, NameTheValueAndTheRule) {
    EXPECT_EQ(medit_error(head + "Tetrahedra 1 1 2 3 5 5 End"), "a cell has vertex 5, but there are 4 Vertices");
    EXPECT_EQ(medit_error(head + "Tetrahedra 1 0 2 3 4 5 End"),
              "Tetrahedra: entry 1 has vertex 0, but vertices are counted from 1 to 4");
    EXPECT_EQ(medit_error(head + "Tetrahedra 2 1 2 3 4 5 End"),
              "Tetrahedra: states 2 entries, but there is room for 1 at most");
    EXPECT_EQ(medit_error(head + "Tetrahedra 1 1 2 3 4 End"),
              "Tetrahedra: states 1 entries, but entry 1 is broken or missing at line 1 ('End')");
    EXPECT_EQ(medit_error(head + "Tetrahedra 1 1 2 3 4 5 6 End"),
              "a keyword should stand at line 1 ('6'): a section holds more than it states");
    EXPECT_EQ(medit_error("MeshVersionFormatted 2 Dimension 3 End"), "has no section Vertices");
    EXPECT_EQ(medit_error("something else"), "begins with 'something else', but a Medit file begins with "
                                             "MeshVersionFormatted, a binary one with the number 1");
}

TEST(ReadMeditErrors, OfTheSolutionSaySo) {
    const std::string mesh = head + "Tetrahedra 1 1 2 3 4 5 End";
    EXPECT_EQ(medit_error(mesh, "MeshVersionFormatted 2 Dimension 3 SolAtVertices 3 1 1 1 2 3 End"),
              "the .sol file beside it has values for 3 vertices, but there are 4");
    EXPECT_EQ(
        medit_error(mesh, "MeshVersionFormatted 2 Dimension 3 SolAtVertices 4 1 9 1 2 3 4 End"),
        "the .sol file beside it: SolAtVertices: field 1 is of kind 9, but 1 to 4 are the rule, at line 1 (its end)");
}

} // namespace
} // namespace isotet::test
