// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTM, VTPC, VTPD, file series, and structured grids in pieces: VTK XML files that name others.
#include <gtest/gtest.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkMultiPieceDataSet.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLMultiBlockDataWriter.h>
#include <vtkXMLPImageDataWriter.h>

#include <isotet/read.hpp>

#include "support/temporary_folder.hpp"
#include "vtk_readers/sample_grid.hpp"

namespace isotet::test {
namespace {

void name(vtkMultiBlockDataSet* tree, unsigned int block, const char* text) {
    tree->GetMetaData(block)->Set(vtkCompositeDataSet::NAME(), text);
}

/// A field "height" that is x.
vtkSmartPointer<vtkImageData> image(int first, int last) {
    auto grid = vtkSmartPointer<vtkImageData>::New();
    grid->SetExtent(first, last, 0, 2, 0, 2);
    vtkNew<vtkDoubleArray> values;
    values->SetName("height");
    for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i) values->InsertNextValue(grid->GetPoint(i)[0]);
    grid->GetPointData()->AddArray(values);
    return grid;
}

/// "internal": the sample; without a name, a block of "wall", a surface, nothing, and "parts", two pieces.
vtkSmartPointer<vtkMultiBlockDataSet> tree() {
    auto root = vtkSmartPointer<vtkMultiBlockDataSet>::New();
    root->SetBlock(0, sample_grid());
    name(root, 0, "internal");
    vtkNew<vtkMultiBlockDataSet> others;
    vtkNew<vtkPolyData> wall;
    vtkNew<vtkPoints> point;
    point->InsertNextPoint(0, 0, 0);
    wall->SetPoints(point);
    others->SetBlock(0, wall);
    name(others, 0, "wall");
    others->SetBlock(1, nullptr);
    vtkNew<vtkMultiPieceDataSet> parts;
    parts->SetPiece(0, image(100, 102));
    parts->SetPiece(1, image(102, 105));
    others->SetBlock(2, parts);
    name(others, 2, "parts");
    root->SetBlock(1, others);
    return root;
}

class Blocks : public testing::Test {
protected:
    Blocks() {
        vtkNew<vtkXMLMultiBlockDataWriter> writer;
        writer->SetInputData(tree());
        writer->SetFileName(folder_.file("a.vtm").c_str());
        writer->Write();
        write_vtu(sample_grid(), folder_.file("s.vtu"), Encoding::appended_raw);
    }
    Result<ReadResult> read_blocks(std::vector<std::string> blocks, const char* file = "a.vtm") {
        ReadOptions options;
        options.blocks = std::move(blocks);
        return read(folder_.file(file), options);
    }
    std::string error_of(std::string_view file, const std::string& content) {
        const auto result = read(folder_.write(file, content));
        return result ? "read" : result.error().message;
    }
    TemporaryFolder folder_;
};

std::string index(std::string_view type, std::string_view elements) {
    const std::string name(type);
    return "<VTKFile type=\"" + name + "\"><" + name + ">" + std::string(elements) + "</" + name + "></VTKFile>\n";
}

std::string multi_block(std::string_view elements) { return index("vtkMultiBlockDataSet", elements); }

TEST_F(Blocks, AreListedWithTheirPathsAndCells) {
    const auto info = inspect(folder_.file("a.vtm"));
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_EQ(info->format, "vtm");
    ASSERT_EQ(info->blocks.size(), 2u);
    EXPECT_EQ(info->blocks[0].number, 1);
    EXPECT_EQ(info->blocks[0].name, "internal");
    EXPECT_EQ(info->blocks[0].cells, static_cast<std::uint64_t>(sample_grid()->GetNumberOfCells()));
    EXPECT_EQ(info->blocks[1].number, 2);
    EXPECT_EQ(info->blocks[1].name, "block 2/parts");
    EXPECT_EQ(info->blocks[1].cells, 8u + 12u);
    EXPECT_EQ(info->files.size(), 3u);
}

TEST_F(Blocks, AreOneGridWithoutAChoice) {
    const auto all = read_blocks({});
    ASSERT_TRUE(all) << all.error().message;
    EXPECT_EQ(all->grid.cells.count(), static_cast<std::size_t>(sample_grid()->GetNumberOfCells()) + 20);
    EXPECT_EQ(all->grid.points.tuples(), static_cast<std::size_t>(sample_grid()->GetNumberOfPoints()) + 6 * 9);
    const std::vector<std::string>& notes = all->notes;
    EXPECT_EQ(std::ranges::count(notes, "2 structured grids were read as 20 hexahedra"), 1);
    EXPECT_EQ(std::ranges::count(notes, "1 surface that the file names is left out"), 1);
}

TEST_F(Blocks, AreChosenByNameOrNumber) {
    expect_sample(read_blocks({"internal"}));
    expect_sample(read_blocks({"1"}));
    for (const char* chosen : {"block 2", "parts", "block 2/parts", "2"}) {
        const auto parts = read_blocks({chosen});
        ASSERT_TRUE(parts) << chosen << ": " << parts.error().message;
        EXPECT_EQ(parts->grid.cells.count(), 20u) << chosen;
        EXPECT_EQ(parts->grid.points.tuples(), 54u) << "of the pieces' common side once";
        ASSERT_EQ(parts->info.blocks.size(), 2u) << "the others are told, too";
        EXPECT_GT(parts->info.blocks[0].cells, 0u);
    }
    const auto both = read_blocks({"internal", "parts"});
    ASSERT_TRUE(both) << both.error().message;
    EXPECT_EQ(both->grid.cells.count(), static_cast<std::size_t>(sample_grid()->GetNumberOfCells()) + 20);
}

TEST_F(Blocks, AreChosenByAnyPartOfTheirPath) {
    folder_.write("deep.vtm", multi_block(R"(<Block index="0" name="g"><Block index="0" name="x">
        <DataSet index="0" name="m" file="s.vtu"/></Block></Block>)"));
    for (const char* chosen : {"g", "x", "m", "g/x", "x/m", "g/x/m"}) expect_sample(read_blocks({chosen}, "deep.vtm"));
    EXPECT_FALSE(read_blocks({"g/m"}, "deep.vtm"));
}

TEST_F(Blocks, ThatAreNotThereAreAnErrorWithThoseThatAre) {
    for (const char* asked : {"wall", "3", "0", ""}) {
        const auto result = read_blocks({asked});
        ASSERT_FALSE(result) << asked;
        EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
        EXPECT_NE(result.error().message.find("1 'internal', 2 'block 2/parts'"), std::string::npos)
            << result.error().message;
    }
}

TEST_F(Blocks, OfAPartitionedCollectionAreItsPartitions) {
    folder_.write("a.vtpc", index("vtkPartitionedDataSetCollection",
                                  "<Partitions index=\"0\" name=\"fluid\"><DataSet index=\"0\" file=\"s.vtu\"/>"
                                  "<DataSet index=\"1\"/></Partitions>"
                                  "<Partitions index=\"1\"><DataSet index=\"0\" file=\"s.vtu\"/></Partitions>"));
    const auto info = inspect(folder_.file("a.vtpc"));
    ASSERT_TRUE(info) << info.error().message;
    ASSERT_EQ(info->blocks.size(), 2u);
    EXPECT_EQ(info->blocks[0].name, "fluid");
    EXPECT_EQ(info->blocks[1].name, "block 2");
    expect_sample(read_blocks({"fluid"}, "a.vtpc"));
}

TEST_F(Blocks, APartitionedDataSetIsOneGridWithoutBlocks) {
    folder_.write("a.vtpd", index("vtkPartitionedDataSet", "<DataSet index=\"0\" file=\"s.vtu\"/>"));
    expect_sample(read_blocks({}, "a.vtpd"));
    const auto chosen = read_blocks({"1"}, "a.vtpd");
    ASSERT_FALSE(chosen);
    EXPECT_NE(chosen.error().message.find("no blocks"), std::string::npos);
}

TEST_F(Blocks, MayBeGridsInPieces) {
    folder_.write("p.pvtu", "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid>"
                            "<Piece Source=\"s.vtu\"/></PUnstructuredGrid></VTKFile>");
    folder_.write("b.vtm", multi_block("<DataSet name=\"p\" file=\"p.pvtu\"/>"));
    expect_sample(read_blocks({"p"}, "b.vtm"));
}

TEST_F(Blocks, WhoseFileIsMissingAreLeftOut) {
    folder_.write("p.pvtu", "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid>"
                            "<Piece Source=\"gone_0.vtu\"/></PUnstructuredGrid></VTKFile>");
    const std::string_view elements =
        "<DataSet name=\"gone\" file=\"no.vtu\"/><DataSet name=\"there\" file=\"s.vtu\"/>";
    folder_.write("m.vtm", multi_block(elements));
    folder_.write("pieces.vtm", multi_block(std::string(elements) + "<DataSet name=\"p\" file=\"p.pvtu\"/>"));
    folder_.write("m.vtpc", index("vtkPartitionedDataSetCollection",
                                  "<Partitions name=\"gone\"><DataSet file=\"no.vtu\"/></Partitions>"
                                  "<Partitions name=\"there\"><DataSet file=\"s.vtu\"/></Partitions>"));
    for (const char* file : {"m.vtm", "m.vtpc", "pieces.vtm"}) {
        SCOPED_TRACE(file);
        expect_sample(read_blocks({"there"}, file));
        const auto all = read_blocks({}, file);
        expect_sample(all);
        ASSERT_TRUE(all);
        const std::string begin =
            file == std::string("pieces.vtm") ? "2 files are left out, this one first: " : "a file is left out: ";
        EXPECT_EQ(std::ranges::count_if(all->notes,
                                        [&](const std::string& note) {
                                            return note.starts_with(begin) && note.find("no.vtu") != std::string::npos;
                                        }),
                  1);
        const auto gone = read_blocks({"gone"}, file);
        ASSERT_FALSE(gone);
        EXPECT_NE(gone.error().message.find("no.vtu"), std::string::npos) << gone.error().message;
        ReadOptions options;
        options.blocks = {"there"};
        EXPECT_TRUE(inspect(folder_.file(file), options));
    }
    folder_.write("m.vtpd", index("vtkPartitionedDataSet", "<DataSet file=\"no.vtu\"/><DataSet file=\"s.vtu\"/>"));
    EXPECT_FALSE(read_blocks({}, "m.vtpd")) << "its files are pieces of one grid";
}

TEST_F(Blocks, BrokenIndexesAreErrors) {
    EXPECT_NE(error_of("b.vtm", multi_block("")).find("names no files"), std::string::npos);
    EXPECT_NE(error_of("b.vtm", multi_block("<DataSet file=\"wall.vtp\"/>")).find("are surfaces"), std::string::npos);
    EXPECT_NE(error_of("b.vtm", multi_block("<DataSet file=\"c.vtm\"/>")).find("only .vtu"), std::string::npos);
    EXPECT_NE(error_of("b.vtm", multi_block("<DataSet file=\"grid.xyz\"/>")).find("grid.xyz"), std::string::npos);
    EXPECT_NE(error_of("b.vtm", multi_block("<DataSet file=\"no.vtu\"/>")).find("no.vtu"), std::string::npos);
    EXPECT_NE(error_of("b.vtm", multi_block("<DataSet file=\"../s.vtu\"/>")).find("its own folder"), std::string::npos);
    EXPECT_NE(error_of("b.vtm", multi_block("<DataSet file=\"s.vtu\"/>").substr(0, 70)), "read");
    std::string deep;
    for (int i = 0; i < 100'000; ++i) deep += "<Block>";
    deep += "<DataSet file=\"s.vtu\"/>";
    for (int i = 0; i < 100'000; ++i) deep += "</Block>";
    EXPECT_NE(error_of("b.vtm", multi_block(deep)).find("more than 64"), std::string::npos);
}

TEST_F(Blocks, AFileSeriesHasTheBlocksOfItsFiles) {
    folder_.write("run.vtm.series", R"({"file-series-version": "1.0", "files": [
        {"name": "a.vtm", "time": 2.5}, {"name": "s.vtu", "time": -1}]})");
    const auto info = inspect(folder_.file("run.vtm.series"));
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_EQ(info->format, "series");
    EXPECT_EQ(info->times, (std::vector<double>{-1, 2.5}));
    expect_sample(read_blocks({}, "run.vtm.series"));
    ReadOptions options;
    options.step = 1;
    options.blocks = {"internal"};
    expect_sample(read(folder_.file("run.vtm.series"), options));
}

TEST_F(Blocks, BrokenFileSeriesAreErrors) {
    const auto error = [&](const char* text) { return error_of("run.vtu.series", text); };
    EXPECT_NE(error("{\"files\": [],}").find("not JSON, from byte 14 on"), std::string::npos);
    EXPECT_NE(error("[]").find("files"), std::string::npos);
    EXPECT_NE(error(R"({"files": []})").find("files"), std::string::npos);
    EXPECT_NE(error(R"({"files": [{"time": 1}]})").find("no \"name\""), std::string::npos);
    EXPECT_NE(error(R"({"files": [{"name": "s.vtu"}, {"name": "s.vtu", "time": 1}]})").find("no number"),
              std::string::npos);
    EXPECT_NE(error(R"({"files": [{"name": "s.vtu", "time": "1 s"}]})").find("no number"), std::string::npos);
    EXPECT_NE(error(R"({"files": [{"name": "../s.vtu", "time": 1}]})").find("its own folder"), std::string::npos);
    EXPECT_NE(error(R"({"files": [{"name": "run.vtu.series", "time": 1}]})").find("names itself"), std::string::npos);
}

TEST(StructuredInPieces, AreTheGridOfTheWhole) {
    const TemporaryFolder folder;
    vtkNew<vtkXMLPImageDataWriter> writer;
    writer->SetInputData(image(0, 6));
    writer->SetFileName(folder.file("a.pvti").c_str());
    writer->SetNumberOfPieces(3);
    writer->SetStartPiece(0);
    writer->SetEndPiece(2);
    writer->SetGhostLevel(1);
    ASSERT_TRUE(writer->Write());
    const auto result = read(folder.file("a.pvti"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.format, "pvti");
    EXPECT_EQ(result->info.files.size(), 3u);
    EXPECT_EQ(result->grid.cells.count(), 24u) << "without the ghost cells";
    EXPECT_EQ(result->grid.points.tuples(), 63u);
    for (std::size_t i = 0; i < 63; ++i)
        EXPECT_EQ(result->grid.point_fields.at(0).values.at(i), result->grid.points.at(i, 0));
}

} // namespace
} // namespace isotet::test
