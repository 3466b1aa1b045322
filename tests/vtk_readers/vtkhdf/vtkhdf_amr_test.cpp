// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTKHDF of type OverlappingAMR: the grid of the same boxes in VTH, steps, and what is broken.
#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "vtk_readers/hdf5_writer.hpp"
#include "readers/amr_sample.hpp"
#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

/// Levels as they are in the first step; in the second step all but the last.
struct HdfAmrFile {
    io::amr::Hierarchy boxes = nested_boxes(2, 2);
    bool steps = false;
    std::vector<double> origin = {-1, -1, -1};
    std::size_t spacings = 3, box_columns = 6;
    std::int64_t boxes_more = 0; ///< that the steps claim
    std::string axes = "XYZ";

    void write(const std::string& path) const {
        Hdf5Writer file(path);
        file.group("/VTKHDF");
        file.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{2, 3});
        file.attribute("/VTKHDF", "Type", "OverlappingAMR");
        file.attribute("/VTKHDF", "GridDescription", axes);
        file.real_attribute("/VTKHDF", "Origin", origin);
        if (steps) {
            file.group("/VTKHDF/Steps");
            file.data<double>("/VTKHDF/Steps/Values", {0.25, 1}, {2});
        }
        for (std::size_t level = 0; level < boxes.levels.size(); ++level) write_level(file, level);
    }

private:
    void write_level(Hdf5Writer& file, std::size_t level) const {
        const std::string name = fmt::format("Level{}", level), group = "/VTKHDF/" + name;
        const auto& spacing = boxes.levels[level].spacing;
        file.group(group);
        file.group(group + "/CellData");
        file.real_attribute(group, "Spacing",
                            {spacing.begin(), spacing.begin() + static_cast<std::ptrdiff_t>(spacings)});
        const int count = !steps ? 1 : level + 1 < boxes.levels.size() ? 2 : 1;
        std::vector<std::int32_t> rows;
        std::vector<double> values;
        for (int step = 0; step < count; ++step)
            for (const io::amr::CellBox& box : boxes.levels[level].boxes) {
                for (std::size_t i = 0; i < box_columns; ++i)
                    rows.push_back(static_cast<std::int32_t>(i % 2 == 0 ? box.first[i / 2] : box.last[i / 2]));
                for (const auto& middle : middles_of(boxes, level, box)) values.push_back(middle[0] + step);
            }
        const auto of_step = static_cast<std::int64_t>(boxes.levels[level].boxes.size());
        const auto cells = static_cast<std::int64_t>(values.size()) / count;
        file.data<std::int32_t>(group + "/AMRBox", rows, {rows.size() / box_columns, box_columns});
        file.data<double>(group + "/CellData/s", values, {values.size()});
        if (!steps) return;
        const std::string at = "/VTKHDF/Steps/" + name;
        file.group(at);
        file.group(at + "/CellDataOffsets");
        file.data<std::int64_t>(at + "/NumberOfAMRBoxes", {of_step + boxes_more, of_step * (count - 1)}, {2});
        file.data<std::int64_t>(at + "/AMRBoxOffsets", {0, of_step}, {2});
        file.data<std::int64_t>(at + "/CellDataOffsets/s", {0, cells}, {2});
    }
};

Result<ReadResult> read_written(const HdfAmrFile& file, const ReadOptions& options = {}) {
    const TemporaryFolder folder;
    file.write(folder.file("a.vtkhdf"));
    return read(folder.file("a.vtkhdf"), options);
}

void expect_same_bytes(const Array& a, const Array& b) {
    ASSERT_EQ(a.type(), b.type());
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.bytes()), 0);
}

TEST(ReadVtkHdfAmr, IsTheGridOfTheSameBoxesInVth) {
    const TemporaryFolder folder;
    for (const std::int64_t ratio : {2, 4}) {
        const auto boxes = nested_boxes(2, ratio);
        const auto expected = read(AmrFile{boxes}.write(folder.file("")));
        ASSERT_TRUE(expected) << expected.error().message;
        const auto found = read_written({boxes});
        ASSERT_TRUE(found) << found.error().message;
        expect_same_bytes(found->grid.points, expected->grid.points);
        expect_same_bytes(found->grid.cells.connectivity, expected->grid.cells.connectivity);
        expect_same_bytes(found->grid.point_fields.at(0).values, expected->grid.point_fields.at(0).values);
        expect_same_bytes(found->grid.cell_fields.at(0).values, expected->grid.cell_fields.at(0).values);
    }
}

TEST(ReadVtkHdfAmr, EachStepHasItsOwnBoxesAndValues) {
    HdfAmrFile file;
    file.steps = true;
    ReadOptions second;
    second.step = 1;
    const auto at_start = read_written(file), later = read_written(file, second);
    ASSERT_TRUE(at_start) << at_start.error().message;
    ASSERT_TRUE(later) << later.error().message;
    EXPECT_EQ(later->info.times, (std::vector<double>{0.25, 1}));
    io::amr::Hierarchy coarser = nested_boxes(2, 2);
    coarser.levels.pop_back();
    const auto expected = read_written({coarser});
    expect_same_bytes(later->grid.points, expected->grid.points);
    const Array &values = later->grid.cell_fields.at(0).values, &before = expected->grid.cell_fields.at(0).values;
    for (std::size_t cell = 0; cell < values.size(); ++cell) ASSERT_EQ(values.at(cell), before.at(cell) + 1);
    EXPECT_EQ(at_start->grid.cells.count(), read_written({})->grid.cells.count());
}

void expect_error(const std::function<void(HdfAmrFile&)>& change, const std::string& text) {
    HdfAmrFile file;
    change(file);
    const auto result = read_written(file);
    ASSERT_FALSE(result) << text;
    EXPECT_EQ(result.error().code, ErrorCode::invalid_data);
    EXPECT_NE(result.error().message.find(text), std::string::npos) << result.error().message;
}

TEST(ReadVtkHdfAmr, WhatDoesNotFitIsAnErrorThatSaysSo) {
    expect_error([](HdfAmrFile& file) { file.origin.pop_back(); }, "attribute Origin of 2 numbers, not 3");
    expect_error([](HdfAmrFile& file) { file.spacings = 2; },
                 "\"Level0\" has an attribute Spacing of 2 numbers, not 3");
    expect_error([](HdfAmrFile& file) { file.box_columns = 4; }, "\"Level0/AMRBox\" does not hold rows of 6 integers");
    expect_error([](HdfAmrFile& file) { file.axes = "XY"; }, "must be of three dimensions");
    expect_error([](HdfAmrFile& file) { file.boxes.levels[1].spacing[2] = 0.2; }, "must be a whole multiple");
    expect_error([](HdfAmrFile& file) { file.steps = true, file.boxes_more = 7; },
                 "has 4 rows, but 9 from row 0 on are needed");
    expect_error([](HdfAmrFile& file) { file.boxes.levels.clear(); }, "\"Level0/AMRBox\" is not there");
}

TEST(ReadVtkHdfAmr, ListsArraysThatAreNoTables) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.vtkhdf");
    HdfAmrFile().write(path);
    Hdf5Writer(path, {}).data<double>("/VTKHDF/Level0/CellData/single", {1}, {});
    const auto result = read(path);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cell_fields.size(), 1u);
    for (const auto& left_out : {result->info.left_out, inspect(path).value().left_out}) {
        ASSERT_EQ(left_out.size(), 1u);
        EXPECT_EQ(left_out[0].name, "single");
    }
}

TEST(ReadVtkHdfAmr, TheFilesInDataAreTheSameGrid) {
    const std::string folder = (source_folder() / "data/amr").string() + "/";
    const auto xml = read(folder + "sphere_amr.vth"), hdf = read(folder + "sphere_amr.vtkhdf");
    ASSERT_TRUE(xml) << xml.error().message;
    ASSERT_TRUE(hdf) << hdf.error().message;
    expect_same_bytes(hdf->grid.points, xml->grid.points);
    expect_same_bytes(hdf->grid.cells.connectivity, xml->grid.cells.connectivity);
    const Array &doubles = xml->grid.cell_fields.at(0).values, &floats = hdf->grid.cell_fields.at(0).values;
    for (std::size_t cell = 0; cell < doubles.size(); ++cell)
        ASSERT_EQ(static_cast<float>(doubles.at(cell)), static_cast<float>(floats.at(cell)));
}

} // namespace
} // namespace isotet::test
