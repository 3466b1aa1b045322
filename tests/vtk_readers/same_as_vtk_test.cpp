// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Our readers of VTK's formats against VTK's: the same bits of every array, and no other values of broken files.
#include <random>

#include <gtest/gtest.h>
#include <vtkBitArray.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkCellData.h>
#include <vtkRectilinearGrid.h>
#include <vtkRectilinearGridWriter.h>
#include <vtkStringArray.h>
#include <vtkStructuredGrid.h>
#include <vtkStructuredGridWriter.h>
#include <vtkStructuredPoints.h>
#include <vtkStructuredPointsWriter.h>
#include <vtkUnstructuredGridWriter.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLRectilinearGridWriter.h>
#include <vtkXMLStructuredGridWriter.h>
#include <vtkXMLUnstructuredGridReader.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <isotet/read.hpp>

#include "support/places.hpp"
#include "support/temporary_folder.hpp"
#include "vtk_readers/sample_grid.hpp"
#include "vtk_readers/vtk_digest.hpp"

namespace isotet::test {
namespace {

/// How a file is written.
struct Way {
    const char* name;
    int mode; ///< of vtkXMLWriter
    bool encoded = false;
    int compressor = vtkXMLWriter::NONE;
    int header = vtkXMLWriter::UInt64;
    int order = vtkXMLWriter::LittleEndian;
};
constexpr Way ways[] = {
    {"ascii", vtkXMLWriter::Ascii},
    {"base64", vtkXMLWriter::Binary},
    {"base64_32", vtkXMLWriter::Binary, false, vtkXMLWriter::NONE, vtkXMLWriter::UInt32},
    {"base64_zlib", vtkXMLWriter::Binary, false, vtkXMLWriter::ZLIB},
    {"base64_zlib_32_big", vtkXMLWriter::Binary, false, vtkXMLWriter::ZLIB, vtkXMLWriter::UInt32,
     vtkXMLWriter::BigEndian},
    {"appended_base64", vtkXMLWriter::Appended, true},
    {"appended_base64_lz4", vtkXMLWriter::Appended, true, vtkXMLWriter::LZ4, vtkXMLWriter::UInt32},
    {"raw", vtkXMLWriter::Appended},
    {"raw_32_big", vtkXMLWriter::Appended, false, vtkXMLWriter::NONE, vtkXMLWriter::UInt32, vtkXMLWriter::BigEndian},
    {"raw_zlib", vtkXMLWriter::Appended, false, vtkXMLWriter::ZLIB},
    {"raw_lz4", vtkXMLWriter::Appended, false, vtkXMLWriter::LZ4},
    {"raw_lzma_big", vtkXMLWriter::Appended, false, vtkXMLWriter::LZMA, vtkXMLWriter::UInt64, vtkXMLWriter::BigEndian}};

template <class Writer>
void write_so(vtkDataObject* data, const std::string& path, const Way& way) {
    vtkNew<Writer> writer;
    writer->SetFileName(path.c_str());
    writer->SetInputData(data);
    writer->SetDataMode(way.mode);
    writer->SetEncodeAppendedData(way.encoded);
    writer->SetCompressorType(way.compressor);
    writer->SetHeaderType(way.header);
    writer->SetByteOrder(way.order);
    writer->SetBlockSize(4096); // several blocks an array
    ASSERT_TRUE(writer->Write());
}

void expect_same(const std::string& path, const std::string& what) {
    const auto ours = read(path);
    ASSERT_TRUE(ours) << what << ": " << ours.error().message;
    EXPECT_EQ(digest(ours->grid), read_with_vtk(path)) << what;
}

/// The sample, with arrays of every type, of bits and of strings.
vtkSmartPointer<vtkUnstructuredGrid> rich_sample() {
    const auto grid = sample_grid();
    for (const int type : {VTK_SIGNED_CHAR, VTK_UNSIGNED_CHAR, VTK_SHORT, VTK_UNSIGNED_SHORT, VTK_UNSIGNED_INT,
                           VTK_UNSIGNED_LONG_LONG, VTK_BIT}) {
        const auto array = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
        array->SetName(array->GetDataTypeAsString());
        array->SetNumberOfTuples(grid->GetNumberOfPoints());
        for (vtkIdType i = 0; i < grid->GetNumberOfPoints(); ++i)
            array->SetTuple1(i, type == VTK_BIT ? i % 3 == 0 : i * 7);
        grid->GetPointData()->AddArray(array);
    }
    vtkNew<vtkStringArray> words;
    words->SetName("words");
    for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i) words->InsertNextValue("a word");
    grid->GetCellData()->AddArray(words);
    return grid;
}

template <class Data>
void add_values(Data* data) {
    vtkNew<vtkFloatArray> of_points;
    of_points->SetName("p");
    of_points->SetNumberOfComponents(2);
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i)
        of_points->InsertNextTuple2(static_cast<double>(i) / 7, static_cast<double>(i * i));
    data->GetPointData()->AddArray(of_points);
    vtkNew<vtkDoubleArray> of_cells;
    of_cells->SetName("c");
    for (vtkIdType i = 0; i < data->GetNumberOfCells(); ++i) of_cells->InsertNextValue(static_cast<double>(i) / 3);
    data->GetCellData()->AddArray(of_cells);
}

vtkSmartPointer<vtkImageData> sample_image() {
    auto image = vtkSmartPointer<vtkImageData>::New();
    image->SetExtent(-2, 4, 3, 7, 10, 13);
    image->SetOrigin(0.1, -7, 1e6);
    image->SetSpacing(0.3, 1.7, 2);
    image->SetDirectionMatrix(0, -1, 0, 1, 0, 0, 0, 0, 1);
    add_values(image.Get());
    return image;
}

vtkSmartPointer<vtkRectilinearGrid> sample_ticks() {
    auto grid = vtkSmartPointer<vtkRectilinearGrid>::New();
    grid->SetExtent(1, 4, 0, 4, -3, 2);
    vtkNew<vtkFloatArray> along[3];
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 4 + axis; ++i) along[axis]->InsertNextValue(static_cast<float>(i * i) / 3);
    grid->SetXCoordinates(along[0]);
    grid->SetYCoordinates(along[1]);
    grid->SetZCoordinates(along[2]);
    add_values(grid.Get());
    return grid;
}

vtkSmartPointer<vtkStructuredGrid> sample_curved() {
    auto grid = vtkSmartPointer<vtkStructuredGrid>::New();
    grid->SetExtent(2, 5, 1, 5, 0, 2);
    vtkNew<vtkPoints> points;
    for (int i = 0; i < 4 * 5 * 3; ++i) points->InsertNextPoint(i % 4 + 0.1 * i, i / 4 % 5, i / 20);
    grid->SetPoints(points);
    add_values(grid.Get());
    return grid;
}

/// Reads changed copies of a file: what we read of them is what VTK reads, or left out, or an error with a sentence.
void expect_same_of_changed(const std::string& whole, const std::string& ending, const char* what) {
    const TemporaryFolder folder;
    std::mt19937 random(20260807);
    int read_by_us = 0;
    for (int round = 0; round < 60; ++round) {
        std::string changed = whole;
        const std::size_t head = std::min<std::size_t>(whole.size(), round % 2 ? whole.size() : 6000);
        for (unsigned changes = 1 + random() % 2; changes > 0; --changes) {
            const std::size_t at = random() % head;
            if (random() % 2) changed[at] = static_cast<char>('0' + random() % 10);
            else changed[at] = static_cast<char>(random());
        }
        const std::string path = folder.write("changed" + ending, changed);
        const auto ours = read(path);
        if (!ours) {
            EXPECT_FALSE(ours.error().message.empty());
            EXPECT_NE(ours.error().code, ErrorCode::internal) << ours.error().message;
            continue;
        }
        ++read_by_us;
        const auto theirs = read_with_vtk_apart(path);
        if (theirs.empty()) continue; // VTK crashes on some files that are sound where it matters
        if (ours->info.left_out.empty()) {
            EXPECT_EQ(digest(ours->grid), theirs) << what << ", round " << round;
            continue;
        }
        for (const std::string& line : digest(ours->grid)) // VTK keeps what it could read of a broken array
            EXPECT_NE(std::ranges::find(theirs, line), theirs.end()) << line << ", " << what << ", round " << round;
    }
    EXPECT_GT(read_by_us, 0);
}

class SameAsVtk : public testing::TestWithParam<Way> {
protected:
    TemporaryFolder folder_;
};

TEST_P(SameAsVtk, ForUnstructuredGridsOfEveryKind) {
    write_so<vtkXMLUnstructuredGridWriter>(rich_sample(), folder_.file("rich.vtu"), GetParam());
    expect_same(folder_.file("rich.vtu"), "the sample");
    for (const char* name :
         {"artery_flow_tet_wedge", "patch_antenna_efield", "quadratic_tets_96", "stokes_channel_tets"}) {
        vtkNew<vtkXMLUnstructuredGridReader> reader;
        reader->SetFileName((source_folder() / "data/vtu" / (std::string(name) + ".vtu")).c_str());
        reader->Update();
        write_so<vtkXMLUnstructuredGridWriter>(reader->GetOutput(), folder_.file("a.vtu"), GetParam());
        expect_same(folder_.file("a.vtu"), name);
    }
}

TEST_P(SameAsVtk, ForStructuredGrids) {
    write_so<vtkXMLImageDataWriter>(sample_image(), folder_.file("a.vti"), GetParam());
    expect_same(folder_.file("a.vti"), "image");

    write_so<vtkXMLRectilinearGridWriter>(sample_ticks(), folder_.file("a.vtr"), GetParam());
    expect_same(folder_.file("a.vtr"), "rectilinear");

    write_so<vtkXMLStructuredGridWriter>(sample_curved(), folder_.file("a.vts"), GetParam());
    expect_same(folder_.file("a.vts"), "structured");
}

TEST_P(SameAsVtk, OrAnErrorWhateverIsChanged) {
    write_so<vtkXMLUnstructuredGridWriter>(rich_sample(), folder_.file("whole.vtu"), GetParam());
    expect_same_of_changed(content_of(folder_.file("whole.vtu")), ".vtu", GetParam().name);
}

INSTANTIATE_TEST_SUITE_P(Ways, SameAsVtk, testing::ValuesIn(ways),
                         [](const auto& way) { return std::string(way.param.name); });

struct LegacyWay {
    bool binary;
    int version;
};
class LegacySameAsVtk : public testing::TestWithParam<LegacyWay> {
protected:
    template <class Writer>
    std::string written(vtkDataObject* data) {
        vtkNew<Writer> writer;
        writer->SetFileName(folder_.file("a.vtk").c_str());
        writer->SetInputData(data);
        writer->SetFileVersion(GetParam().version);
        if (GetParam().binary) writer->SetFileTypeToBinary();
        else writer->SetFileTypeToASCII();
        EXPECT_TRUE(writer->Write());
        return folder_.file("a.vtk");
    }
    TemporaryFolder folder_;
};

TEST_P(LegacySameAsVtk, ForGridsOfEveryKind) {
    expect_same(written<vtkUnstructuredGridWriter>(rich_sample()), "unstructured");
    vtkNew<vtkImageData> image;
    image->SetDimensions(5, 4, 3);
    image->SetOrigin(0.1, -7, 1e6);
    image->SetSpacing(0.3, 1.7, 2);
    add_values(image.Get());
    expect_same(written<vtkStructuredPointsWriter>(image), "structured points");
    expect_same(written<vtkRectilinearGridWriter>(sample_ticks()), "rectilinear");
    expect_same(written<vtkStructuredGridWriter>(sample_curved()), "structured");
}

TEST_P(LegacySameAsVtk, OrAnErrorWhateverIsChanged) {
    expect_same_of_changed(content_of(written<vtkUnstructuredGridWriter>(rich_sample())), ".vtk", "legacy");
}

INSTANTIATE_TEST_SUITE_P(Ways, LegacySameAsVtk,
                         testing::Values(LegacyWay{false, 42}, LegacyWay{true, 42}, LegacyWay{false, 51},
                                         LegacyWay{true, 51}));

TEST(SameAsVtkOf, EveryFileInData) {
    for (const char* folder : {"data/vtu", "data/vtk"})
        for (const auto& entry : std::filesystem::directory_iterator(source_folder() / folder)) {
            const std::string path = entry.path().string();
            if (path.ends_with(".vtu") || path.ends_with(".vtk")) expect_same(path, path);
        }
}

} // namespace
} // namespace isotet::test
