// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polyhedra of Exodus: NFACED blocks of NSIDED faces, beside hexahedra.
#include <functional>
#include <string>

#include "support/temporary_folder.hpp"
#include "vtk_readers/polyhedral_exodus.hpp"

namespace isotet::test {
namespace {

Result<ReadResult> read_exodus(const Grid& grid, const std::function<void(ExodusBlocks&)>& change = {},
                               const ReadOptions& options = {}, int format = 0) {
    const TemporaryFolder folder;
    write_polyhedral_exodus(grid, folder.file("a.exo"), format, change);
    return read(folder.file("a.exo"), options);
}

TEST(ExodusPolyhedra, HaveNoHolesAndTheirOwnValues) {
    const Grid sample = octree_for_files();
    const ExodusBlocks blocks(sample);
    for (const int format : {0, EX_64BIT_DATA, EX_NETCDF4}) {
        const auto result = read_exodus(sample, {}, {}, format);
        ASSERT_TRUE(result) << result.error().message;
        ASSERT_EQ(result->grid.cells.count(), sample.cells.count());
        EXPECT_EQ(survey(result->grid).value().cells_by_type, survey(sample).value().cells_by_type);
        std::vector<double> numbers;
        for (const auto& block : blocks.cells_of)
            for (const std::size_t cell : block) numbers.push_back(static_cast<double>(cell));
        for (std::size_t i = 0; i < numbers.size(); ++i)
            ASSERT_EQ(result->grid.cell_fields.at(0).values.at(i), numbers[i]);
        expect_sound_polyhedra(result->grid);
        expect_surface_of(sample, result->grid);
    }
}

TEST(ExodusPolyhedra, ThatAreHexahedraGiveTheirSurface) {
    const Grid hexahedra = hexahedra_for_files();
    const auto result = read_exodus(as_polyhedra(hexahedra, Listed::ascending, 4));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(linearize(result->grid).value().report.known_shapes, hexahedra.cells.count());
    expect_surface_of(hexahedra, result->grid);
}

TEST(ExodusPolyhedra, OfABlockAloneHaveThePointsThatTheyUse) {
    const Grid sample = octree_for_files();
    const ExodusBlocks blocks(sample);
    ReadOptions options;
    options.blocks = {"30"};
    const auto result = read_exodus(sample, {}, options);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), blocks.cells_of[2].size());
    EXPECT_LT(result->grid.points.tuples(), sample.points.tuples());
    EXPECT_EQ(survey(result->grid).value().unused_points, 0u);
    EXPECT_EQ(result->info.blocks.at(2).cells, blocks.cells_of[2].size());
    expect_sound_polyhedra(result->grid);
}

TEST(ExodusPolyhedra, ThatAreBrokenAreErrors) {
    const Grid sample = octree_for_files();
    const auto expect = [&](const std::function<void(ExodusBlocks&)>& change, const std::string& part) {
        const auto result = read_exodus(sample, change);
        ASSERT_FALSE(result) << part;
        EXPECT_NE(result.error().message.find("a.exo: "), std::string::npos) << result.error().message;
        EXPECT_EQ(result.error().message.find("a.exo: "), result.error().message.rfind("a.exo: "));
        EXPECT_NE(result.error().message.find(part), std::string::npos) << result.error().message;
    };
    expect([](ExodusBlocks& b) { b.faces[1].numbers[3] = 344; }, "a face has node 344, but the nodes are 1 to 343");
    expect([](ExodusBlocks& b) { b.faces[1].numbers[3] = 0; }, "a face has node 0, but");
    expect([](ExodusBlocks& b) { b.faces[0].counts[3] += 1; }, "face block 1, whose counts (fbepecnt1) have");
    expect([](ExodusBlocks& b) { b.faces[0].counts[3] = -4; }, "face block 1, whose counts (fbepecnt1) have");
    expect([](ExodusBlocks& b) { b.polyhedra[1].numbers[3] = 0; },
           "an element of block 30 has face 0, but the faces are 1 to");
    expect([](ExodusBlocks& b) { b.polyhedra[0].numbers[3] = 99999; }, "an element of block 20 has face 99999, but");
    expect([](ExodusBlocks& b) { b.polyhedra[0].counts[0] += 1; }, "element block 20, whose counts (ebepecnt2) have");
    expect([](ExodusBlocks& b) { b.face_topology = "quad"; }, "face block 1");
}

TEST(ExodusPolyhedra, OfAFileThatIsCutAreAnError) {
    const TemporaryFolder folder;
    write_polyhedral_exodus(octree_for_files(), folder.file("a.exo"));
    const std::string whole = content_of(folder.file("a.exo"));
    for (const std::size_t size : {whole.size() - 1, whole.size() / 2, whole.size() / 5}) {
        const auto result = read(folder.write("cut.exo", whole.substr(0, size)));
        ASSERT_FALSE(result) << size;
        EXPECT_NE(result.error().message.find("cut.exo: "), std::string::npos) << result.error().message;
    }
}

} // namespace
} // namespace isotet::test
