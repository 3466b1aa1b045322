// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// MSH files of every kind give the grid that was written into them.
#include <cmath>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/gmsh/read_gmsh.hpp"
#include "readers/gmsh_sample.hpp"
#include "readers/sample_bytes.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

ReadResult read_step(const std::string& bytes, std::size_t step) {
    ReadOptions options;
    options.step = step;
    return io::parse_gmsh(bytes, options, {}).value();
}

void expect_values(const std::vector<Field>& fields, std::string_view name, const std::vector<double>& expected) {
    const Field* field = find(fields, name);
    ASSERT_NE(field, nullptr) << name;
    const std::vector<double> values = values_of(field->values);
    ASSERT_EQ(values.size(), expected.size()) << name;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (std::isnan(expected[i])) EXPECT_TRUE(std::isnan(values[i])) << name << " " << i;
        else EXPECT_EQ(values[i], expected[i]) << name << " " << i;
    }
}

std::string gmsh_error(const std::string& bytes) {
    const auto result = io::parse_gmsh(bytes, {}, {});
    return result ? "no error" : result.error().message;
}

class ReadGmsh : public testing::TestWithParam<GmshVariant> {};

TEST_P(ReadGmsh, GivesPointsAndCellsOfAllKinds) {
    const ReadResult result = read_step(gmsh_sample(GetParam()), 0);
    EXPECT_EQ(result.info.format, "gmsh");
    EXPECT_EQ(result.grid.points.type(), ScalarType::float64);
    EXPECT_EQ(values_of(result.grid.points), cube_points);
    EXPECT_EQ(types_of(result.grid.cells), cube_types);
    EXPECT_EQ(values_of(result.grid.cells.connectivity), cube_connectivity());
    EXPECT_EQ(values_of(result.grid.cells.offsets), (std::vector<double>{0, 3, 7, 15, 21, 26}));
    EXPECT_TRUE(check(result.grid));
}

/// What tells of a file is there without the most of its sections.
TEST_P(ReadGmsh, IsLookedIntoByItsHeads) {
    constexpr int values = 40000;
    std::string section = fmt::format("$NodeData\n1\n\"long\"\n1\n0\n3\n0\n1\n{}\n", values);
    for (int i = 0; i < values; ++i) section += GetParam().binary ? std::string(12, '\0') : "1 0.12345678\n";
    const std::string bytes = gmsh_sample(GetParam()) + section + "\n$EndNodeData\n";
    for (const bool searches : {false, true}) {
        const auto heads = io::heads_of_gmsh(io::ByteSource(bytes), searches, {}).value();
        ASSERT_TRUE(heads);
        EXPECT_LT(heads->size(), bytes.size() / 2);
        const FileInfo some = io::inspect_gmsh(*heads, {}).value(), all = io::inspect_gmsh(bytes, {}).value();
        EXPECT_EQ(some.times, all.times);
        ASSERT_EQ(some.fields.size(), all.fields.size());
        for (std::size_t i = 0; i < all.fields.size(); ++i) EXPECT_EQ(some.fields[i].name, all.fields[i].name);
        ASSERT_EQ(some.regions.size(), all.regions.size());
        EXPECT_EQ(some.left_out.size(), all.left_out.size());
    }
    std::string longer = bytes; // than what is searched
    longer.insert(longer.find("$NodeData"), "$Notes\n" + std::string(2 << 20, 'x') + "\n$EndNotes\n");
    EXPECT_FALSE(io::heads_of_gmsh(io::ByteSource(longer), false, {}).value());
    EXPECT_TRUE(io::heads_of_gmsh(io::ByteSource(longer), true, {}).value());
}

TEST_P(ReadGmsh, GivesTheFieldsOfEachStep) {
    const std::string bytes = gmsh_sample(GetParam());
    for (const std::size_t step : {0, 1}) {
        const ReadResult result = read_step(bytes, step);
        EXPECT_EQ(result.info.times, (std::vector<double>{0, 1.5}));
        EXPECT_EQ(result.step, step);
        std::vector<double> temperature;
        for (int i = 0; i < 9; ++i) temperature.push_back(10.0 * static_cast<double>(step + 1) * (i + 1));
        expect_values(result.grid.point_fields, "temperature", temperature);
        std::vector<double> flow(27, nan);
        for (const int i : {0, 1}) {
            flow[static_cast<std::size_t>(3 * i)] = i;
            flow[static_cast<std::size_t>(3 * i + 1)] = i + 0.5;
            flow[static_cast<std::size_t>(3 * i + 2)] = -i;
        }
        expect_values(result.grid.point_fields, "flow", flow);
        expect_values(result.grid.cell_fields, "porosity", {nan, 0.2, 0.3, 0.4, 0.5});
    }
}

TEST_P(ReadGmsh, GivesPhysicalGroupsAndEntities) {
    const ReadResult result = read_step(gmsh_sample(GetParam()), 0);
    expect_values(result.grid.cell_fields, "gmsh:physical", {7, 8, 8, 8, 8});
    expect_values(result.grid.cell_fields, "gmsh:geometrical", {3, 4, 4, 4, 4});
    EXPECT_EQ(find(result.grid.cell_fields, "gmsh:physical")->values.type(), ScalarType::int32);
}

TEST_P(ReadGmsh, NamesThePhysicalGroupsOfVolumes) {
    const std::string bytes = gmsh_sample(GetParam());
    const FileInfo info = io::inspect_gmsh(bytes, {}).value();
    ASSERT_EQ(info.regions.size(), 1u);
    EXPECT_EQ(info.regions[0].field, "gmsh:physical");
    EXPECT_EQ(info.regions[0].number, 8);
    EXPECT_EQ(info.regions[0].name, "a $ in a name");
    const std::string names = "1\n3 8 \"a $ in a name\"\n";
    const auto with = [&](const std::string& others) {
        std::string changed = bytes;
        return changed.replace(changed.find(names), names.size(), others);
    };
    const FileInfo more = io::inspect_gmsh(with("3\n2 1 \"face\"\n3 8 \"\"\n3 9 \"say \"x\"\"\n"), {}).value();
    ASSERT_EQ(more.regions.size(), 2u) << "surfaces have none";
    EXPECT_EQ(more.regions[0].name, "");
    EXPECT_EQ(more.regions[1].name, "say \"x\"");
    for (const char* wrong : {"x\n", "-1\n", "2\n3 8 \"one\"\n", "1\n3 8 one\n", "1\n3 8 \"one\n", "1\n3\n"}) {
        EXPECT_TRUE(io::inspect_gmsh(with(wrong), {}).value().regions.empty()) << wrong;
        const std::vector<std::string> notes = io::parse_gmsh(with(wrong), {}, {}).value().notes;
        EXPECT_TRUE(std::ranges::any_of(notes, [](const std::string& note) {
            return note.starts_with("$PhysicalNames");
        })) << wrong;
    }
}

TEST_P(ReadGmsh, AnnouncesWhatItReads) {
    const std::string bytes = gmsh_sample(GetParam());
    const FileInfo info = io::inspect_gmsh(bytes, {}).value();
    const ReadResult result = read_step(bytes, 0);
    ASSERT_EQ(info.fields.size(), result.grid.point_fields.size() + result.grid.cell_fields.size());
    for (const FieldInfo& field : info.fields) {
        const bool point = field.association == Association::point;
        const Field* read = find(point ? result.grid.point_fields : result.grid.cell_fields, field.name);
        ASSERT_NE(read, nullptr) << field.name;
        EXPECT_EQ(read->values.type(), field.type);
        EXPECT_EQ(read->values.components(), field.components);
    }
    EXPECT_EQ(info.times, result.info.times);
}

INSTANTIATE_TEST_SUITE_P(EveryVariant, ReadGmsh, testing::ValuesIn(gmsh_variants()),
                         [](const auto& variant) { return name_of(variant.param); });

const std::string tets =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n"
    "$EndNodes\n$Elements\n2\n1 4 0 1 2 3 4\n2 4 0 2 3 4 5\n$EndElements\n";

TEST(ReadGmshTets, HaveNeitherTypesNorOffsetsNorTags) {
    const ReadResult result = io::parse_gmsh(tets, {}, {}).value();
    EXPECT_TRUE(result.grid.cells.types.empty());
    EXPECT_TRUE(result.grid.cells.offsets.empty());
    EXPECT_EQ(result.grid.cells.uniform_type, CellType::tetrahedron);
    EXPECT_EQ(values_of(result.grid.cells.connectivity), (std::vector<double>{0, 1, 2, 3, 1, 2, 3, 4}));
    EXPECT_TRUE(result.info.fields.empty());
    EXPECT_TRUE(result.info.times.empty());
}

TEST(ReadGmshTets, KeepHigherOrderCellsWithVtksNumbers) {
    std::string bytes = replaced(tets, "2\n1 4 0 1 2 3 4", "3\n1 11 0 1 2 3 4 5 1 2 3 4 5\n3 4 0 1 2 3 4");
    const ReadResult result = io::parse_gmsh(bytes, {}, {}).value();
    EXPECT_EQ(types_of(result.grid.cells), (std::vector<int>{24, 10, 10}));
}

TEST(ReadGmshTets, MayHaveWindowsLineEnds) {
    std::string bytes;
    for (const char c : tets) bytes += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_EQ(values_of(io::parse_gmsh(bytes, {}, {}).value().grid.cells.connectivity).size(), 8U);
}

TEST(ReadGmshTets, MayHaveElementsBeforeNodes) {
    const std::size_t nodes = tets.find("$Nodes"), elements = tets.find("$Elements");
    const std::string bytes = tets.substr(0, nodes) + tets.substr(elements) + tets.substr(nodes, elements - nodes);
    EXPECT_EQ(values_of(io::parse_gmsh(bytes, {}, {}).value().grid.cells.connectivity).size(), 8U);
}

TEST(ReadGmshErrors, NameTheValueAndTheRule) {
    EXPECT_EQ(gmsh_error(replaced(tets, "1 2 3 4\n2 4", "1 2 3 9\n2 4")),
              "$Elements: element 1 has node 9, which is not among the nodes");
    EXPECT_EQ(gmsh_error(replaced(tets, "\n2 1 0 0", "\n1 1 0 0")),
              "$Nodes: node 1 occurs twice, but numbers must be unique");
    EXPECT_EQ(gmsh_error(replaced(tets, "5 1 1 1", "5 1 x 1")),
              "$Nodes: states 5 nodes, but node 5 is broken or missing at line 6 ('x') of the section");
    EXPECT_EQ(gmsh_error(replaced(tets, "$Nodes\n5", "$Nodes\n4")),
              "$Nodes: holds more than it states, at line 6 ('5') of the section");
    EXPECT_EQ(gmsh_error(replaced(tets, "$Nodes\n5", "$Nodes\n-5")),
              "$Nodes: states -5 nodes, but there is room for 5 at most");
    EXPECT_EQ(gmsh_error(replaced(tets, "$Nodes\n5", "$Nodes\n99999999999999")),
              "$Nodes: states 99999999999999 nodes, but there is room for 5 at most");
    EXPECT_EQ(gmsh_error(replaced(tets, "\n2 4 0", "\n2 34 0")),
              "$Elements: element 2 has type 34, which isotet does not know");
    EXPECT_EQ(gmsh_error(replaced(tets, "$EndElements\n", "")),
              "$Elements: has no $EndElements: the file is cut short");
    EXPECT_EQ(gmsh_error(replaced(tets, "2.2 0", "3.0 0")),
              "$MeshFormat: says version 3, but isotet reads 1.0, 2.0 to 2.2, 4.0 and 4.1 (gmsh -save -format msh41 "
              "converts)");
    EXPECT_EQ(gmsh_error(""), "has no $MeshFormat section, so it is no MSH file");
}

TEST(ReadGmshErrors, NameTheSectionThatIsMissing) {
    EXPECT_EQ(gmsh_error(tets.substr(0, tets.find("$Elements"))), "has no $Elements section");
}

/// A data section of one component.
std::string data_section(const std::string& kind, const std::string& name, int count, const std::string& values,
                         int step = 0) {
    return fmt::format("${}\n1\n\"{}\"\n1\n0\n3\n{}\n1\n{}\n{}\n$End{}\n", kind, name, step, count, values, kind);
}

std::vector<std::string> left_out(const FileInfo& info) {
    std::vector<std::string> all;
    for (const LeftOut& item : info.left_out)
        all.push_back(fmt::format("{} {}: {}", item.what, item.name, item.reason));
    return all;
}

TEST(ReadGmshFields, ThatAreBrokenAreLeftOutAlone) {
    const std::string sound = data_section("NodeData", "sound", 1, "3 7");
    const auto broken = [&](const std::string& bad, const std::string& reason) {
        for (const std::string& bytes : {tets + bad + sound, tets + sound + bad}) {
            const auto result = io::parse_gmsh(bytes, {}, {});
            ASSERT_TRUE(result) << result.error().message;
            EXPECT_EQ(left_out(result->info), std::vector<std::string>{reason});
            ASSERT_EQ(result->info.fields.size(), 1U);
            expect_values(result->grid.point_fields, "sound", {nan, nan, 7, nan, nan});
        }
    };
    broken(data_section("NodeData", "T", 1, "77 1.5"),
           "point field T: $NodeData: 'T' has a value for node 77, which the file does not have");
    broken(data_section("ElementData", "T", 1, "1 x"),
           "cell field T: $ElementData: 'T' states values of 1 elements, but number 1 is broken or missing at line 9 "
           "('x') of the section");
    broken(data_section("ElementNodeData", "T", 1, "1 5 1 2 3 4 5"),
           "point field T: $ElementNodeData: 'T' has values at 5 nodes of element 1, which has 4");
    broken("$NodeData\n0\n$EndNodeData\n",
           "section $NodeData: $NodeData: has a broken list of tags at line 2 (the end)");
}

TEST(ReadGmshSteps, AreByStepNumberWhereTimesRepeat) {
    std::string bytes = tets;
    for (const int step : {3, 5}) {
        bytes += "$NodeData\n1\n\"T\"\n1\n0\n3\n" + std::to_string(step) + "\n1\n1\n1 " + std::to_string(step) +
                 "\n$EndNodeData\n";
    }
    const ReadResult result = read_step(bytes, 1);
    EXPECT_EQ(result.info.times, (std::vector<double>{3, 5}));
    EXPECT_EQ(result.grid.point_fields.at(0).values.at(0), 5);
}

std::string view_at(std::string_view name, double time, int value) {
    return fmt::format("$NodeData\n1\n\"{}\"\n1\n{}\n3\n0\n1\n1\n1 {}\n$EndNodeData\n", name, time, value);
}

TEST(ReadGmshSteps, AreNotMadeByViewsThatHaveOne) {
    const std::string bytes =
        tets + view_at("k", 0, 1) + view_at("T", 0.25, 2) + view_at("T", 0.5, 3) + view_at("U", 9, 4);
    for (const std::size_t step : {0, 1}) {
        const ReadResult result = read_step(bytes, step);
        EXPECT_EQ(result.info.times, (std::vector<double>{0.25, 0.5}));
        std::vector<double> values;
        for (const Field& field : result.grid.point_fields) values.push_back(field.values.at(0));
        EXPECT_EQ(values, (std::vector<double>{1, step == 0 ? 2.0 : 3.0, 4}));
    }
    const ReadResult result = read_step(tets + view_at("k", 1, 1) + view_at("U", 9, 4), 0);
    EXPECT_TRUE(result.info.times.empty());
    EXPECT_EQ(result.grid.point_fields.size(), 2U);
}

TEST(ReadGmshSteps, AreDescribedOneByOne) {
    const std::string bytes = tets + view_at("T", 3, 1) + view_at("T", 5, 2) + view_at("q", 5, 3) + view_at("q", 6, 4);
    const auto fields_at = [&](std::optional<std::size_t> step) {
        std::string names;
        for (const FieldInfo& field : io::inspect_gmsh(bytes, {}, step).value().fields) names += field.name;
        return names;
    };
    EXPECT_EQ(fields_at(0), "T");
    EXPECT_EQ(fields_at(1), "Tq");
    EXPECT_EQ(fields_at(2), "q");
    EXPECT_EQ(fields_at({}), "Tq");
}

TEST(ReadGmshSteps, OutOfRangeAreRefusedWithTheirNumber) {
    ReadOptions options;
    options.step = 2;
    const auto result = io::parse_gmsh(gmsh_sample({}), options, {});
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(result.error().message, "step 2 is not there, but the file has 2 steps, counted from 0");
}

TEST(ReadGmshFields, ThatNobodyWantsAreNotRead) {
    ReadOptions options;
    options.point_fields = {"flow"};
    options.cell_fields.emplace();
    const ReadResult result = io::parse_gmsh(gmsh_sample({}), options, {}).value();
    ASSERT_EQ(result.grid.point_fields.size(), 1U);
    EXPECT_EQ(result.grid.point_fields[0].name, "flow");
    EXPECT_TRUE(result.grid.cell_fields.empty());
    EXPECT_EQ(result.info.fields.size(), 5U);
}

TEST(ReadGmshFields, WithoutANameHaveThatOfTheSection) {
    for (const char* tags : {"0\n", "1\n\"\"\n"}) {
        const std::string rest = tags + std::string("0\n3\n0\n1\n1\n1 0.5\n");
        const ReadResult result =
            io::parse_gmsh(tets + "$NodeData\n" + rest + "$EndNodeData\n$ElementData\n" + rest + "$EndElementData\n",
                           {}, {})
                .value();
        EXPECT_TRUE(result.info.left_out.empty());
        expect_values(result.grid.point_fields, "NodeData", {0.5, nan, nan, nan, nan});
        ASSERT_EQ(result.grid.cell_fields.size(), 1U);
        EXPECT_EQ(result.grid.cell_fields[0].name, "ElementData");
    }
}

TEST(ReadGmshFields, MayComeInPartsOfOneStep) {
    std::string bytes = tets;
    for (const int node : {1, 2}) {
        bytes += "$NodeData\n1\nwater saturation\n1\n2.5\n4\n0\n1\n1\n" + std::to_string(node) + "\n" +
                 std::to_string(node) + " 0.5\n$EndNodeData\n";
    }
    const ReadResult result = io::parse_gmsh(bytes, {}, {}).value();
    expect_values(result.grid.point_fields, "water saturation", {0.5, 0.5, nan, nan, nan});
    EXPECT_EQ(result.info.times, std::vector<double>{2.5});
}

TEST(ReadGmshFields, OfViewsWithOneNameAreKeptApart) {
    const std::string bytes = tets + data_section("NodeData", "T", 5, "1 1\n2 2\n3 3\n4 4\n5 5") +
                              data_section("NodeData", "T", 5, "1 6\n2 7\n3 8\n4 9\n5 10");
    const ReadResult result = io::parse_gmsh(bytes, {}, {}).value();
    expect_values(result.grid.point_fields, "T", {1, 2, 3, 4, 5});
    expect_values(result.grid.point_fields, "T_1", {6, 7, 8, 9, 10});
    EXPECT_EQ(result.notes, std::vector<std::string>{"several views are called 'T': one of them was read as 'T_1'"});
    const std::string parts =
        tets + data_section("NodeData", "T", 2, "1 1\n2 2") + data_section("NodeData", "T", 2, "2 3\n3 4");
    const ReadResult twice = io::parse_gmsh(parts, {}, {}).value();
    expect_values(twice.grid.point_fields, "T", {1, 3, 4, nan, nan});
    EXPECT_EQ(twice.notes,
              std::vector<std::string>{"point field 'T' has 1 values twice, which differ: the last ones were taken"});
}

TEST(ReadGmshElementNodeData, IsAPointFieldWhereElementsAgree) {
    const std::string bytes =
        tets + data_section("ElementNodeData", "T", 2, "2 4 20 30 40 50\n1 4 10 20 30 40.0000000000001");
    EXPECT_EQ(io::inspect_gmsh(bytes, {}).value().fields.at(0).association, Association::point);
    const ReadResult result = io::parse_gmsh(bytes, {}, {}).value();
    EXPECT_TRUE(result.notes.empty());
    ASSERT_NE(find(result.grid.point_fields, "T"), nullptr);
    const auto values = values_of(result.grid.point_fields[0].values);
    EXPECT_EQ(values[0], 10);
    EXPECT_EQ(values[2], 30);
    EXPECT_NEAR(values[3], 40, 1e-12);
    EXPECT_EQ(values[4], 50);
}

TEST(ReadGmshElementNodeData, BecomesMeansWithANoteWhereElementsDiffer) {
    const std::string bytes = tets + data_section("ElementNodeData", "T", 2, "1 4 10 20 30 40\n2 4 21 30 43 50");
    const ReadResult result = io::parse_gmsh(bytes, {}, {}).value();
    expect_values(result.grid.point_fields, "T", {10, 20.5, 30, 41.5, 50});
    EXPECT_EQ(result.notes, std::vector<std::string>{
                                "point field 'T' has a value for each node of each element ($ElementNodeData): at "
                                "each node the mean was taken of values that differ by up to 3, of a range from "
                                "10 to 50"});
    ReadOptions none;
    none.point_fields.emplace();
    EXPECT_TRUE(io::parse_gmsh(bytes, none, {}).value().notes.empty());
}

TEST(ReadGmshElementNodeData, FollowsTheNodesOfTheFileInCurvedElements) {
    // Gmsh's last two nodes of a quadratic tetrahedron are VTK's in reverse.
    std::string bytes = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n10\n";
    for (int i = 1; i <= 10; ++i) bytes += fmt::format("{} {} {} {}\n", i, i % 2, i % 3, i % 5);
    bytes += "$EndNodes\n$Elements\n1\n1 11 0 1 2 3 4 5 6 7 8 9 10\n$EndElements\n";
    const ReadResult result =
        io::parse_gmsh(bytes + data_section("ElementNodeData", "T", 1, "1 10 1 2 3 4 5 6 7 8 9 10"), {}, {}).value();
    expect_values(result.grid.point_fields, "T", {1, 2, 3, 4, 5, 6, 7, 8, 9, 10});
}

const std::string mesh_sections = tets.substr(tets.find("$Nodes"));

TEST(ReadGmshRepeats, OfTheSameMeshArePassedOverWithANote) {
    const std::string again = replaced(mesh_sections, "5 1 1 1", "5 1.0 1.0 1.0"),
                      data = data_section("NodeData", "T", 1, "3 7");
    for (const std::string& more : {mesh_sections, again}) {
        const ReadResult result =
            io::parse_gmsh(tets + more + data + "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n" + more, {}, {}).value();
        EXPECT_EQ(result.grid.cells.count(), 2U);
        expect_values(result.grid.point_fields, "T", {nan, nan, 7, nan, nan});
        EXPECT_EQ(result.notes,
                  std::vector<std::string>{"$Elements, $Nodes occur again, as Gmsh writes them before each "
                                           "view that it appends: the first were taken"});
    }
}

TEST(ReadGmshRepeats, OfAnotherMeshAreErrorsThatSayWhich) {
    EXPECT_EQ(gmsh_error(tets + replaced(mesh_sections, "\n5 1 1 1", "\n6 1 1 1")),
              "$Nodes: occurs twice, with other numbers of nodes: a file has one mesh");
    EXPECT_EQ(gmsh_error(tets + replaced(mesh_sections, "2\n1 4 0 1 2 3 4", "1")),
              "$Elements: occurs twice, with 2 and with 1 elements: a file has one mesh");
    EXPECT_EQ(gmsh_error(tets + replaced(mesh_sections, "\n2 4 0", "\n3 4 0")),
              "$Elements: occurs twice, with other numbers of elements: a file has one mesh");
}

TEST(ReadGmshSections, ThatAreNotReadAreNamed) {
    const FileInfo info =
        io::inspect_gmsh(tets + "$Periodic\n0\n$EndPeriodic\n$Odd\n1\n$EndOdd\n$Comments\nx\n$EndComments\n", {})
            .value();
    EXPECT_EQ(left_out(info), (std::vector<std::string>{"section $Periodic: it does not change the grid",
                                                        "section $Odd: it is not known"}));
}

TEST(ReadGmshVersion1, HasNodAndElm) {
    const std::string bytes = "$NOD\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$ENDNOD\n$ELM\n2\n"
                              "1 4 7 3 4 1 2 3 4\n2 4 8 4 4 2 3 4 5\n$ENDELM\n";
    const ReadResult result = io::parse_gmsh(bytes, {}, {}).value();
    EXPECT_EQ(values_of(result.grid.cells.connectivity), (std::vector<double>{0, 1, 2, 3, 1, 2, 3, 4}));
    EXPECT_EQ(result.grid.points.at(4, 2), 1);
    expect_values(result.grid.cell_fields, "gmsh:physical", {7, 8});
    expect_values(result.grid.cell_fields, "gmsh:geometrical", {3, 4});
    EXPECT_EQ(gmsh_error(replaced(bytes, "1 4 7 3 4 1", "1 4 7 3 5 1")),
              "$ELM: element 1 of type 4 states 5 nodes, but has 4");
    EXPECT_EQ(gmsh_error(replaced(bytes, "$ENDELM\n", "")), "$ELM: has no $ENDELM: the file is cut short");
    EXPECT_EQ(gmsh_error(bytes.substr(0, bytes.find("$ELM"))), "has no $ELM section");
}

TEST(ReadGmshGroups, OfVersion2MayShareElementsThatAreThereForEach) {
    const std::string bytes = replaced(tets, "2\n1 4 0 1 2 3 4\n2 4 0 2 3 4 5\n",
                                       "5\n1 4 2 7 1 1 2 3 4\n2 4 2 9 1 1 2 3 4\n3 4 2 8 1 1 2 3 4\n"
                                       "4 4 2 9 1 2 3 4 5\n5 4 2 9 1 2 3 4 5\n");
    const ReadResult result = io::parse_gmsh(bytes, {}, {}).value();
    EXPECT_EQ(result.grid.cells.count(), 3u) << "an element that is there twice in one group is the file's own mistake";
    expect_values(result.grid.cell_fields, "gmsh:physical", {7, 9, 9});
    ASSERT_EQ(result.notes.size(), 1u);
    EXPECT_EQ(result.notes[0], "2 elements are there again for another physical group: the first was taken; `block` "
                               "takes all of a group");
    ReadOptions chosen;
    chosen.blocks = {"9"};
    EXPECT_EQ(io::parse_gmsh(bytes, chosen, {}).value().grid.cells.count(), 5u) << "the choice comes later";
}

TEST(ReadGmshGroups, OfVersion20HaveNamesWithoutDimensions) {
    const std::string names = "$PhysicalNames\n2\n7\"rock\"\n8 \"a cave\"\n$EndPhysicalNames\n";
    const std::string bytes =
        replaced(replaced(tets, "2.2 0 8\n$EndMeshFormat\n", "2.0 0 8\n$EndMeshFormat\n" + names), "1 4 0", "1 4 1 7");
    const FileInfo info = io::inspect_gmsh(replaced(bytes, "2 4 0", "2 4 1 8"), {}).value();
    ASSERT_EQ(info.regions.size(), 2u);
    EXPECT_EQ(info.regions[1].number, 8);
    EXPECT_EQ(info.regions[1].name, "a cave");
}

TEST(ReadGmshPartitions, OfVersion2AreTheFirstOfTheirTags) {
    const std::string bytes =
        replaced(replaced(tets, "1 4 0 1 2", "1 4 6 7 2 3 2 -3 -1 1 2"), "2 4 0 2 3", "2 4 4 8 3 1 1 2 3");
    const ReadResult result = io::parse_gmsh(bytes, {}, {}).value();
    expect_values(result.grid.cell_fields, "gmsh:physical", {7, 8});
    expect_values(result.grid.cell_fields, "gmsh:geometrical", {2, 3});
    expect_values(result.grid.cell_fields, "gmsh:partition", {2, 1});
}

/// A partitioned mesh of version 4.0 or 4.1: two tetrahedra of the volume 1, which is cut into the entities 5 and 6.
std::string partitioned(bool version_41, bool binary) {
    SampleBytes out;
    const auto text = [&](std::string_view words) { out.text(words); };
    const auto integer = [&](std::int32_t value) {
        if (binary) out.number(value);
        else out.text(fmt::format("{} ", value));
    };
    const auto count = [&](std::int64_t value) {
        if (binary) out.number(value);
        else out.text(fmt::format("{} ", value));
    };
    const auto tag = [&](std::int32_t value) { version_41 ? count(value) : integer(value); };
    const auto reals = [&](std::initializer_list<double> values) {
        for (const double value : values)
            if (binary) out.number(value);
            else out.text(fmt::format("{} ", value));
    };
    text(fmt::format("$MeshFormat\n{} {} 8\n", version_41 ? "4.1" : "4", binary ? 1 : 0));
    if (binary) out.number(std::int32_t{1}).text("\n");
    text("$EndMeshFormat\n$PhysicalNames\n1\n3 8 \"ball\"\n$EndPhysicalNames\n$Entities\n");
    for (const int entities : {1, 0, 0, 1}) count(entities);
    integer(1);
    version_41 ? reals({0, 0, 0}) : reals({0, 0, 0, 0, 0, 0});
    count(0);
    integer(1);
    reals({0, 0, 0, 1, 1, 1});
    count(1), integer(8), count(0);
    text("\n$EndEntities\n$PartitionedEntities\n");
    count(2), count(1), integer(9), integer(2);
    for (const int entities : {1, 0, 0, 2}) count(entities);
    integer(4), integer(0), integer(1), count(2), integer(2), integer(1);
    version_41 ? reals({0, 0, 0}) : reals({0, 0, 0, 0, 0, 0});
    count(0);
    for (const int volume : {5, 6}) {
        integer(volume), integer(3), integer(1), count(1), integer(volume - 4);
        reals({0, 0, 0, 1, 1, 1});
        count(volume == 5 ? 2 : 0);
        if (volume == 5) integer(8), integer(80);
        count(1), integer(-3);
    }
    text("\n$EndPartitionedEntities\n$Nodes\n");
    count(1), count(5);
    if (version_41) count(1), count(5);
    version_41 ? integer(3) : integer(5);
    version_41 ? integer(5) : integer(3);
    integer(0), count(5);
    for (int i = 0; version_41 && i < 5; ++i) tag(i + 1);
    for (std::size_t i = 0; i < 5; ++i) {
        if (!version_41) tag(static_cast<std::int32_t>(i) + 1);
        reals({cube_points[3 * i], cube_points[3 * i + 1], cube_points[3 * i + 2]});
    }
    text("\n$EndNodes\n$Elements\n");
    count(2), count(2);
    if (version_41) count(1), count(2);
    for (const int volume : {5, 6}) {
        version_41 ? integer(3) : integer(volume);
        version_41 ? integer(volume) : integer(3);
        integer(4), count(1), tag(volume - 4);
        for (const int node : {1, 2, 4, 5}) tag(volume == 6 && node == 1 ? 3 : node);
    }
    text("\n$EndElements\n");
    return out.str();
}

TEST(ReadGmshPartitions, OfVersion4HaveTheGroupsAndEntitiesThatWereCut) {
    for (const bool version_41 : {false, true})
        for (const bool binary : {false, true}) {
            const auto result = io::parse_gmsh(partitioned(version_41, binary), {}, {});
            ASSERT_TRUE(result) << version_41 << binary << result.error().message;
            expect_values(result->grid.cell_fields, "gmsh:physical", {8, 8});
            expect_values(result->grid.cell_fields, "gmsh:geometrical", {1, 1});
            expect_values(result->grid.cell_fields, "gmsh:partition", {1, 2});
            EXPECT_EQ(values_of(result->grid.cells.connectivity), (std::vector<double>{0, 1, 3, 4, 2, 1, 3, 4}));
            EXPECT_EQ(values_of(result->grid.points),
                      std::vector<double>(cube_points.begin(), cube_points.begin() + 15));
            ASSERT_EQ(result->info.regions.size(), 1U);
            EXPECT_EQ(result->info.regions[0].name, "ball");
            ReadOptions chosen;
            chosen.blocks = {"80"}; // the second group of one of the entities
            const ReadResult other = io::parse_gmsh(partitioned(version_41, binary), chosen, {}).value();
            expect_values(other.grid.cell_fields, "gmsh:physical", {80, 8});
            chosen.blocks = {"ball"};
            const ReadResult named = io::parse_gmsh(partitioned(version_41, binary), chosen, {}).value();
            expect_values(named.grid.cell_fields, "gmsh:physical", {8, 8});
        }
}

TEST(ReadGmshPartitions, LeaveOutGhostElementsButKnowTheirNumbers) {
    // The second block lies on the ghost entity 9.
    const std::string bytes = replaced(partitioned(true, false), "3 6 4 1 2 ", "3 9 4 1 2 ") +
                              data_section("ElementData", "T", 2, "1 10\n2 20");
    const ReadResult result = io::parse_gmsh(bytes, {}, {}).value();
    EXPECT_EQ(result.grid.cells.count(), 1U);
    expect_values(result.grid.cell_fields, "gmsh:partition", {1});
    expect_values(result.grid.cell_fields, "T", {10});
    EXPECT_EQ(result.notes, std::vector<std::string>{"1 ghost or blanked cells were left out"});
}

TEST(ReadGmshPartitions, SavedInSeveralFilesAreNamed) {
    const TemporaryFolder folder;
    const std::string first = folder.write("mesh_1.msh", partitioned(true, false));
    EXPECT_TRUE(read(first)->notes.empty());
    folder.write("mesh_2.msh", partitioned(true, false));
    EXPECT_EQ(
        read(first)->notes,
        std::vector<std::string>{"the mesh was saved in a file for each partition: mesh_2.msh and others of the name "
                                 "are not read"});
    EXPECT_TRUE(read(folder.write("whole_1.msh", tets))->notes.empty());
}

TEST(ReadGmshForms, MayChangeWithAViewThatIsAppended) {
    const std::string bytes = tets + SampleBytes()
                                         .text("$MeshFormat\n2.2 1 8\n")
                                         .number(std::int32_t{1})
                                         .text("\n$EndMeshFormat\n$NodeData\n1\n\"T\"\n1\n0\n3\n0\n1\n1\n")
                                         .number(std::int32_t{3})
                                         .number(7.0)
                                         .text("\n$EndNodeData\n")
                                         .str();
    expect_values(io::parse_gmsh(bytes, {}, {}).value().grid.point_fields, "T", {nan, nan, 7, nan, nan});
    EXPECT_EQ(gmsh_error(tets + "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"),
              "$MeshFormat: occurs twice, with different versions");
}

TEST(ReadGmshCancel, EndsWithCancelled) {
    std::string bytes = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n200000\n";
    for (int i = 0; i < 200000; ++i) bytes += std::to_string(i + 1) + " 0 0 0\n";
    bytes += "$EndNodes\n$Elements\n0\n$EndElements\n";
    std::atomic<bool> cancel{true};
    Progress progress;
    progress.cancel = &cancel;
    const auto result = io::parse_gmsh(bytes, {}, progress);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::cancelled);
}

} // namespace
} // namespace isotet::test
