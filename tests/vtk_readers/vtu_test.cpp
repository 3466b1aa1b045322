// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTU files that VTK wrote, whole and broken.
#include <gtest/gtest.h>
#include <vtkCellData.h>
#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>

#include <isotet/read.hpp>

#include "vtk_readers/sample_grid.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

class ReadVtu : public testing::TestWithParam<Encoding> {};

TEST_P(ReadVtu, GivesTheGridThatWasWritten) {
    const TemporaryFolder folder;
    write_vtu(sample_grid(), folder.file("sample.vtu"), GetParam());
    expect_sample(read(folder.file("sample.vtu")));
}

TEST_P(ReadVtu, IsAnErrorForEveryTruncation) {
    const TemporaryFolder folder;
    write_vtu(sample_grid(), folder.file("sample.vtu"), GetParam());
    std::string content = content_of(folder.file("sample.vtu"));
    while (content.ends_with('\n')) content.pop_back();
    read_prefixes(content, "cut.vtu", content.size() / 25 + 1,
                  [](const Result<ReadResult>& result, std::size_t length) {
                      EXPECT_FALSE(result) << "cut to " << length << " bytes";
                  });
}

INSTANTIATE_TEST_SUITE_P(Encodings, ReadVtu,
                         testing::Values(Encoding::ascii, Encoding::base64, Encoding::appended_base64,
                                         Encoding::appended_raw, Encoding::appended_raw_compressed));

TEST(ReadVtu, RecognizesTheContentWhateverTheName) {
    const TemporaryFolder folder;
    write_vtu(sample_grid(), folder.file("sample.data"), Encoding::ascii);
    const auto info = inspect(folder.file("sample.data"));
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_EQ(info->format, "vtu");
}

TEST(ReadVtu, AnnouncesFieldsWithTheirTypes) {
    const TemporaryFolder folder;
    write_vtu(sample_grid(), folder.file("sample.vtu"), Encoding::appended_raw);
    const auto info = inspect(folder.file("sample.vtu"));
    ASSERT_TRUE(info) << info.error().message;
    ASSERT_EQ(info->fields.size(), 5u);
    EXPECT_EQ(info->fields[1].name, "velocity");
    EXPECT_EQ(info->fields[1].type, ScalarType::float32);
    EXPECT_EQ(info->fields[1].components, 3u);
    EXPECT_EQ(info->fields[4].name, "quality: a/b");
    EXPECT_EQ(info->fields[4].association, Association::cell);
}

TEST(ReadVtu, ReadsOnlyTheFieldsAskedFor) {
    const TemporaryFolder folder;
    write_vtu(sample_grid(), folder.file("sample.vtu"), Encoding::appended_raw);
    ReadOptions options;
    options.point_fields = {"number"};
    options.cell_fields = std::vector<std::string>{};
    const auto result = read(folder.file("sample.vtu"), options);
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->grid.point_fields.size(), 1u);
    EXPECT_EQ(result->grid.point_fields[0].name, "number");
    EXPECT_TRUE(result->grid.cell_fields.empty());
    EXPECT_EQ(result->info.fields.size(), 5u);
}

TEST(ReadVtu, LeavesGhostCellsOutAndCountsThem) {
    const auto grid = sample_grid();
    vtkNew<vtkUnsignedCharArray> ghosts;
    ghosts->SetName("vtkGhostType");
    for (vtkIdType i = 0; i < grid->GetNumberOfCells(); ++i) ghosts->InsertNextValue(i == 1 || i == 3 ? 1 : 0);
    grid->GetCellData()->AddArray(ghosts);
    const TemporaryFolder folder;
    write_vtu(grid, folder.file("ghosts.vtu"), Encoding::appended_raw);
    const auto result = read(folder.file("ghosts.vtu"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), 7u);
    ASSERT_EQ(result->notes.size(), 1u);
    EXPECT_EQ(result->notes[0], "2 ghost or blanked cells were left out");
    ASSERT_EQ(result->grid.cell_fields.size(), 2u) << "ghost marks are no field";
    EXPECT_EQ(result->grid.cell_fields[0].values.at(1), 5e9 + 2);
}

TEST(ReadVtu, IsAnErrorWhenACellHasAPointThatIsNotThere) {
    const auto grid = sample_grid();
    const vtkIdType corners[] = {0, 1, 2, 14};
    grid->InsertNextCell(10, 4, corners);
    grid->GetCellData()->Initialize();
    const TemporaryFolder folder;
    write_vtu(grid, folder.file("wrong.vtu"), Encoding::appended_raw);
    const auto result = read(folder.file("wrong.vtu"));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::invalid_data);
    EXPECT_NE(result.error().message.find("14"), std::string::npos) << result.error().message;
}

TEST(ReadVtu, SurvivesCountsThatAreNegativeOrHuge) {
    const TemporaryFolder folder;
    write_vtu(sample_grid(), folder.file("sample.vtu"), Encoding::ascii);
    const std::string content = content_of(folder.file("sample.vtu"));
    for (const char* name : {"NumberOfPoints", "NumberOfCells"})
        for (const char* count : {"-1", "9223372036854775807", "1000000000000", "15", "0"}) {
            std::string broken = content;
            const auto begin = broken.find(name) + std::string_view(name).size() + 2;
            broken.replace(begin, broken.find('"', begin) - begin, count);
            const auto result = read(folder.write("broken.vtu", broken));
            EXPECT_FALSE(result) << name << " " << count;
        }
}

} // namespace
} // namespace isotet::test
