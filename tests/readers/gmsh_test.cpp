// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// MSH files of every kind give the grid that was written into them.
#include <cmath>

#include <gtest/gtest.h>

#include "io/own/read_gmsh.hpp"
#include "readers/gmsh_sample.hpp"
#include "readers/sample_bytes.hpp"

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
        const auto refused = io::inspect_gmsh(with(wrong), {});
        ASSERT_FALSE(refused) << wrong;
        EXPECT_EQ(refused.error().code, ErrorCode::invalid_data);
        EXPECT_TRUE(refused.error().message.starts_with("$PhysicalNames")) << refused.error().message;
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
    EXPECT_EQ(gmsh_error(replaced(tets, "2.2 0", "4.0 0")),
              "$MeshFormat: says version 4, but isotet reads 2.0 to 2.2 and 4.1 (gmsh -save -format msh41 converts)");
    EXPECT_EQ(gmsh_error(""), "has no $MeshFormat section, so it is no MSH file");
}

TEST(ReadGmshErrors, NameTheSectionThatIsMissing) {
    EXPECT_EQ(gmsh_error(tets.substr(0, tets.find("$Elements"))), "has no $Elements section");
}

TEST(ReadGmshErrors, RefuseValuesForWhatIsNotThere) {
    const std::string data = "$NodeData\n1\n\"T\"\n1\n0\n3\n0\n1\n1\n77 1.5\n$EndNodeData\n";
    EXPECT_EQ(gmsh_error(tets + data), "$NodeData: 'T' has a value for node 77, which the file does not have");
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
