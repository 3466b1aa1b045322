// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// ReadOptions::blocks of files that number regions: physical groups of Gmsh, references of Medit, regions of TetGen.
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

/// Three tetrahedra in a row, of groups 7, 7 and 9, and a triangle of the group of surfaces 5. Point 100 + i is at x = i.
const char* const gmsh = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
2
2 5 "wall"
3 9 "hot rock"
$EndPhysicalNames
$Nodes
6
100 0 0 0
101 1 0 0
102 2 1 0
103 3 0 1
104 4 2 0
105 5 0 3
$EndNodes
$Elements
4
1 2 2 5 1 100 101 102
2 4 2 7 1 100 101 102 103
3 4 2 7 2 101 102 103 104
4 4 2 9 3 102 103 104 105
$EndElements
$NodeData
1
"T"
1
0
3
0
1
6
100 0
101 1
102 2
103 3
104 4
105 5
$EndNodeData
)";

class Regions : public testing::Test {
protected:
    Result<ReadResult> read_regions(const char* name, const char* content, std::vector<std::string> blocks,
                                    std::optional<std::vector<std::string>> cell_fields = {}) {
        ReadOptions options;
        options.blocks = std::move(blocks);
        options.cell_fields = std::move(cell_fields);
        return read(folder_.write(name, content), options);
    }
    TemporaryFolder folder_;
};

TEST_F(Regions, AreChosenByNumberOrName) {
    for (const char* asked : {"9", "hot rock"}) {
        const auto result = read_regions("a.msh", gmsh, {asked});
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->grid.cells.count(), 1u);
        ASSERT_EQ(result->grid.points.tuples(), 4u);
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(result->grid.points.at(i, 0), static_cast<double>(i + 2));
            EXPECT_EQ(result->grid.point_fields.at(0).values.at(i), static_cast<double>(i + 2));
            EXPECT_EQ(result->grid.cells.connectivity.at(i), static_cast<double>(i));
        }
        EXPECT_EQ(result->notes.back(), "1 of 4 cells are in the chosen regions");
        ASSERT_EQ(result->info.blocks.size(), 3u);
        EXPECT_EQ(result->info.blocks[0].number, 7);
        EXPECT_EQ(result->info.blocks[0].name, "");
        EXPECT_EQ(result->info.blocks[0].cells, 2u);
        EXPECT_EQ(result->info.blocks[0].kind, "region");
        EXPECT_EQ(result->info.blocks[1].name, "hot rock");
        EXPECT_EQ(result->info.blocks[2].name, "wall");
        EXPECT_EQ(result->info.blocks[2].kind, "surface");
    }
    const auto both = read_regions("a.msh", gmsh, {"7", "9"});
    ASSERT_TRUE(both) << both.error().message;
    EXPECT_EQ(both->grid.cells.count(), 3u);
    EXPECT_EQ(both->grid.points.tuples(), 6u);
}

TEST_F(Regions, OfSurfacesAreChosenBehindThoseOfVolumes) {
    std::string text = gmsh;
    for (const char* asked : {"5", "wall"}) {
        const auto result = read_regions("a.msh", text.c_str(), {asked});
        ASSERT_TRUE(result) << result.error().message;
        ASSERT_EQ(result->grid.cells.count(), 1u);
        EXPECT_EQ(result->grid.points.tuples(), 3u);
        EXPECT_EQ(result->grid.point_fields.at(0).values.at(2), 2);
        EXPECT_EQ(result->grid.patches.count(), 0u);
    }
    EXPECT_EQ(read_regions("a.msh", text.c_str(), {"wall", "hot rock"}).value().grid.cells.count(), 2u);
    text.replace(text.find("2 5 \"wall\""), 10, "2 9 \"wall\"");
    text.replace(text.find("2 2 5 1"), 7, "2 2 9 1");
    EXPECT_EQ(read_regions("a.msh", text.c_str(), {"9"}).value().grid.points.tuples(), 4u) << "of volumes first";
    EXPECT_EQ(read_regions("a.msh", text.c_str(), {"wall"}).value().grid.points.tuples(), 3u);
}

TEST_F(Regions, FieldIsThereOnlyWhereItWasAskedFor) {
    const auto without = read_regions("a.msh", gmsh, {"7"}, std::vector<std::string>{});
    ASSERT_TRUE(without) << without.error().message;
    EXPECT_EQ(without->grid.cells.count(), 2u);
    EXPECT_TRUE(without->grid.cell_fields.empty());
    const auto with = read_regions("a.msh", gmsh, {"7"}, std::vector<std::string>{"gmsh:physical"});
    ASSERT_TRUE(with) << with.error().message;
    ASSERT_EQ(with->grid.cell_fields.size(), 1u);
    EXPECT_EQ(with->grid.cell_fields[0].values.at(1), 7);
}

TEST_F(Regions, ThatAreNotThereAreAnErrorWithThoseThatAre) {
    for (const char* asked : {"8", "hot"}) {
        const auto result = read_regions("a.msh", gmsh, {asked});
        ASSERT_FALSE(result) << asked;
        EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
        EXPECT_NE(result.error().message.find("7, 9 'hot rock', 5 'wall'"), std::string::npos)
            << result.error().message;
    }
}

TEST_F(Regions, OfMeditAreReferences) {
    const char* const mesh =
        "MeshVersionFormatted 2 Dimension 3\nVertices 5\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n1 1 1 0\n"
        "Tetrahedra 2\n1 2 3 4 11\n2 3 4 5 -2\nEnd\n";
    const auto result = read_regions("a.mesh", mesh, {"-2"});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), 1u);
    EXPECT_EQ(result->grid.points.tuples(), 4u);
    ASSERT_EQ(result->info.blocks.size(), 2u);
    EXPECT_EQ(result->info.blocks[1].number, 11);
}

TEST_F(Regions, OfTetGenAreTheFirstAttribute) {
    folder_.write("a.node", "5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n");
    const auto result = read_regions("a.ele", "2 4 1\n1 1 2 3 4 10\n2 2 3 4 5 20\n", {"20"});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), 1u);
    EXPECT_EQ(result->grid.points.at(3, 0), 1);
    const auto broken = read_regions("a.ele", "2 4 1\n1 1 2 3 4 0.5\n2 2 3 4 5 20\n", {"0"});
    ASSERT_FALSE(broken) << "0.5 is no number of a region";
}

TEST_F(Regions, FilesWithoutThemSaySo) {
    folder_.write("a.node", "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n");
    const auto result = read_regions("a.ele", "1 4 0\n1 1 2 3 4\n", {"1"});
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("no blocks"), std::string::npos) << result.error().message;
}

} // namespace
} // namespace isotet::test
