// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Medit files of every kind give the grid that was written into them.
#include <unistd.h>

#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/medit/read_medit.hpp"
#include "readers/medit_sample.hpp"
#include "readers/sample_bytes.hpp"
#include "support/temporary_folder.hpp"

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
        constexpr std::size_t places[] = {0, 3, 1, 5, 4, 2}; // of XX XY YY XZ YZ ZZ
        for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(tensor->values.at(n, places[i]), value + static_cast<double>(i));
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

TEST(ReadMeditText, TensorsOfTwoDimensionsHaveVtksOrder) {
    const ReadResult result =
        io::parse_medit("MeshVersionFormatted 2 Dimension 2 Vertices 3 1 2 0 3 4 0 5 6 0 Triangles 1 1 2 3 0 End",
                        "MeshVersionFormatted 2 Dimension 2 SolAtVertices 3 1 3 1 2 3 4 5 6 7 8 9 End", {}, {})
            .value();
    const Field* tensor = find(result.grid.point_fields, "sol");
    ASSERT_TRUE(tensor);
    EXPECT_EQ(values_of(tensor->values), (std::vector<double>{1, 3, 2, 4, 6, 5, 7, 9, 8}));
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

TEST_P(ReadMedit, GivesTheFieldsOfCellsOfEachKind) {
    const std::string mesh = medit_sample(GetParam()), solution = medit_cell_solution_sample(GetParam());
    const FileInfo info = io::inspect_medit(mesh, solution, {}).value();
    const ReadResult result = io::parse_medit(mesh, solution, {}, {}).value();
    ASSERT_EQ(info.fields.size(), 5U);
    EXPECT_EQ(info.fields[1].association, Association::cell);
    EXPECT_EQ(result.info.left_out.size(), 1U) << "triangles";
    EXPECT_EQ(result.info.left_out.at(0).name, "SolAtTriangles");
    EXPECT_EQ(values_of(find(result.grid.point_fields, "sol")->values), std::vector<double>(9, 7));
    const Field* scalar = find(result.grid.cell_fields, "sol");
    const Field* vector = find(result.grid.cell_fields, "sol_1");
    ASSERT_TRUE(scalar && vector);
    EXPECT_TRUE(std::isnan(scalar->values.at(0))) << "a triangle";
    for (std::size_t c = 1; c < 5; ++c) {
        EXPECT_EQ(scalar->values.at(c), static_cast<double>(c));
        EXPECT_EQ(vector->values.at(c, 2), static_cast<double>(c) + 0.5);
    }
}

std::vector<std::string> left_out(std::string_view mesh, std::string_view solution) {
    const auto result = io::parse_medit(mesh, solution, {}, {});
    EXPECT_TRUE(result) << result.error().message;
    std::vector<std::string> all;
    for (const LeftOut& item : result ? result->info.left_out : std::vector<LeftOut>())
        all.push_back(item.what + " " + item.name + ": " + item.reason);
    return all;
}

TEST(ReadMeditSolution, ThatDoesNotFitIsLeftOutAlone) {
    const std::string mesh = head + "Tetrahedra 1 1 2 3 4 5 End", start = "MeshVersionFormatted 2 Dimension 3 ";
    using Reasons = std::vector<std::string>;
    EXPECT_EQ(left_out(mesh, start + "SolAtVertices 3 1 1 1 2 3 End"),
              Reasons{"point field sol: the .sol file beside it has values for 3 vertices, but there are 4"});
    EXPECT_EQ(
        left_out(mesh, start + "SolAtVertices 4 1 9 1 2 3 4 End"),
        Reasons{"point field sol: the .sol file beside it: SolAtVertices: field 1 is of kind 9, but 1 to 4 are the "
                "rule, at line 1 (its end)"});
    EXPECT_EQ(left_out(mesh, start + "SolAtHexahedra 1 1 1 5 SolAtTetrahedra 2 1 1 5 6 End"),
              (Reasons{"cell field sol: the .sol file beside it has values for 1 Hexahedra, but there are 0",
                       "cell field sol: the .sol file beside it has values for 2 Tetrahedra, but there are 1"}));
    EXPECT_EQ(
        left_out(mesh, "no solution"),
        Reasons{"point field sol: the .sol file beside it: begins with 'no solution', but a Medit file begins with "
                "MeshVersionFormatted, a binary one with the number 1"});
    const std::string both = start + "SolAtVertices 4 1 1 1 2 3 4 SolAtTetrahedra 1 2 1 3 5 End";
    const ReadResult result = io::parse_medit(mesh, both, {}, {}).value();
    EXPECT_EQ(values_of(find(result.grid.point_fields, "sol")->values), (std::vector<double>{1, 2, 3, 4}));
    EXPECT_EQ(find(result.grid.cell_fields, "sol"), nullptr);
    ASSERT_EQ(result.info.left_out.size(), 2U) << "sol and sol_1 on cells";
    EXPECT_NE(result.info.left_out[1].reason.find("room for 0 at most"), std::string::npos)
        << result.info.left_out[1].reason;
}

TEST(ReadMeditSolution, BelongsToCurvedCellsWhereThereAreNoOthers) {
    std::string mesh = "MeshVersionFormatted 2 Dimension 3 Vertices 10 ";
    for (int i = 0; i < 10; ++i) mesh += fmt::format("{} {} {} 0 ", i, i % 2, i % 3);
    mesh += "TetrahedraP2 1 1 2 3 4 5 6 7 8 9 10 5 End";
    const ReadResult result =
        io::parse_medit(mesh, "MeshVersionFormatted 2 Dimension 3 SolAtTetrahedra 1 1 1 6 End", {}, {}).value();
    ASSERT_NE(find(result.grid.cell_fields, "sol"), nullptr);
    EXPECT_EQ(result.grid.cell_fields[0].values.at(0), 6);
}

TEST(ReadCompanions, ThroughLinksOutOfTheFolderNeedAllowOutside) {
    const TemporaryFolder folder, elsewhere;
    const auto link = [&](const char* name, const std::string& content) {
        ASSERT_EQ(::symlink(elsewhere.write(name, content).c_str(), folder.file(name).c_str()), 0);
    };
    const std::string mesh = folder.write("a.mesh", head + "Tetrahedra 1 1 2 3 4 5 End");
    link("a.sol", "MeshVersionFormatted 2 Dimension 3 SolAtVertices 4 1 1 1 2 3 4 End");
    const std::string nodes = folder.write("b.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n");
    link("b.ele", "1 4 0\n1 1 2 3 4\n");
    ReadOptions outside;
    outside.allow_outside = true;
    for (const std::string& path : {mesh, nodes}) {
        const auto refused = read(path);
        ASSERT_FALSE(refused) << path;
        EXPECT_NE(refused.error().message.find("`allow_outside`"), std::string::npos) << refused.error().message;
        EXPECT_FALSE(inspect(path)) << path;
        EXPECT_TRUE(read(path, outside)) << path;
    }
    EXPECT_FALSE(read(folder.file("b.ele"))->grid.cells.count() == 0) << "the file itself may be a link";
}

} // namespace
} // namespace isotet::test
