// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Legacy VTK files that VTK wrote, whole and broken.
#include <gtest/gtest.h>
#include <vtkNew.h>
#include <vtkUnstructuredGridWriter.h>

#include <isotet/read.hpp>

#include "vtk_readers/sample_grid.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

struct Kind {
    bool binary;
    int version;
};
class ReadLegacy : public testing::TestWithParam<Kind> {
protected:
    std::string written() const {
        vtkNew<vtkUnstructuredGridWriter> writer;
        writer->SetFileName(folder_.file("sample.vtk").c_str());
        writer->SetInputData(sample_grid());
        writer->SetFileVersion(GetParam().version);
        if (GetParam().binary) writer->SetFileTypeToBinary();
        else writer->SetFileTypeToASCII();
        writer->Write();
        return folder_.file("sample.vtk");
    }
    TemporaryFolder folder_;
};

TEST_P(ReadLegacy, GivesTheGridThatWasWritten) { expect_sample(read(written())); }

TEST_P(ReadLegacy, AnnouncesFieldsWithTheirTypes) {
    const auto info = inspect(written());
    ASSERT_TRUE(info) << info.error().message;
    ASSERT_EQ(info->fields.size(), 5u);
    for (const FieldInfo& field : info->fields) {
        EXPECT_EQ(field.components, field.name == "velocity" ? 3u : 1u) << field.name;
        const bool of_cells = field.name == "quality: a/b" || field.name == "region";
        EXPECT_EQ(field.association, of_cells ? Association::cell : Association::point) << field.name;
        EXPECT_EQ(field.type == ScalarType::float64, field.name == "height") << field.name;
    }
}

/// The format has no end mark: cut between two sections a file is a whole one with fewer fields. It never has other
/// values.
TEST_P(ReadLegacy, IsAnErrorOrHasFewerFieldsForEveryTruncation) {
    const std::string content = content_of(written());
    read_prefixes(content, "cut.vtk", content.size() / 40 + 1,
                  [&](const Result<ReadResult>& result, std::size_t length) {
                      if (!result) return;
                      EXPECT_GT(length, content.find("CELL_TYPES")) << "cut to " << length << " bytes";
                      EXPECT_EQ(result->grid.points.tuples(), 14u);
                      EXPECT_EQ(result->grid.cells.count(), 9u);
                      EXPECT_LT(result->grid.point_fields.size() + result->grid.cell_fields.size(), 5u)
                          << "cut to " << length << " bytes";
                  });
}

INSTANTIATE_TEST_SUITE_P(Kinds, ReadLegacy,
                         testing::Values(Kind{false, 42}, Kind{true, 42}, Kind{false, 51}, Kind{true, 51}));

TEST(ReadLegacy, RefusesPolygonData) {
    const TemporaryFolder folder;
    const auto result =
        read(folder.write("surface.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 0 float\n"));
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("polydata"), std::string::npos) << result.error().message;
}

TEST(ReadLegacy, ReadsStructuredPointsAsHexahedra) {
    const TemporaryFolder folder;
    const auto result = read(
        folder.write("box.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 2\n"
                                "ORIGIN 10 0 0\nSPACING 1 2 4\nPOINT_DATA 12\nSCALARS s short\nLOOKUP_TABLE default\n"
                                "0 1 2 3 4 5 6 7 8 9 10 11\n"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), 2u);
    EXPECT_EQ(result->grid.cells.uniform_type, CellType::hexahedron);
    EXPECT_EQ(result->grid.points.at(11, 0), 12);
    EXPECT_EQ(result->grid.points.at(11, 2), 4);
    EXPECT_EQ(result->grid.point_fields.at(0).values.type(), ScalarType::int16);
}

} // namespace
} // namespace isotet::test
