// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTKHDF whose partitions are in files of their own: virtual data sets of HDF5.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include <isotet/read.hpp>

#include "support/temporary_folder.hpp"
#include "vtk_readers/hdf5_writer.hpp"

namespace isotet::test {
namespace {

/// A main file and two parts of one tet each beside it.
class ReadVirtualVtkhdf : public testing::Test {
protected:
    ReadVirtualVtkhdf() {
        std::filesystem::create_directories(folder_.file("case"));
        for (const int part : {0, 1}) {
            Hdf5Writer file(folder_.file("case/" + name_of(part)));
            write_groups(file);
            const double x = 10 * part;
            file.data<std::int64_t>("/VTKHDF/NumberOfPoints", {4}, {1});
            file.data<std::int64_t>("/VTKHDF/NumberOfCells", {1}, {1});
            file.data<std::int64_t>("/VTKHDF/NumberOfConnectivityIds", {4}, {1});
            file.data<double>("/VTKHDF/Points", {x, 0, 0, x + 1, 0, 0, x, 1, 0, x, 0, 1}, {4, 3});
            file.data<std::uint8_t>("/VTKHDF/Types", {10}, {1});
            file.data<std::int64_t>("/VTKHDF/Connectivity", {0, 1, 2, 3}, {4});
            file.data<std::int64_t>("/VTKHDF/Offsets", {0, 4}, {2});
            file.stored<double>("/VTKHDF/PointData/p", {x, x + 1, x + 2, x + 3}, {4}, {.chunk = {4}, .deflated = true});
        }
    }
    static std::string name_of(int part) { return "a_part" + std::to_string(part) + ".vtkhdf"; }
    static void write_groups(Hdf5Writer& file) {
        for (const char* name : {"/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/CellData", "/VTKHDF/FieldData"})
            file.group(name);
        file.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{2, 0});
        file.attribute("/VTKHDF", "Type", "UnstructuredGrid");
    }
    static std::vector<Hdf5Writer::RowsElsewhere> both(const std::string& name, hsize_t rows) {
        return {{name_of(0), name, rows, 0}, {name_of(1), name, rows, rows}};
    }
    Result<ReadResult> read_main(const std::vector<Hdf5Writer::RowsElsewhere>& of_field, hsize_t rows = 8) const {
        {
            Hdf5Writer file(folder_.file("case/a.vtkhdf"));
            write_groups(file);
            for (const std::string name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"})
                file.virtual_rows<std::int64_t>("/VTKHDF/" + name, both("/VTKHDF/" + name, 1), 2);
            file.virtual_rows<double>("/VTKHDF/Points", both("/VTKHDF/Points", 4), 8, 3);
            file.virtual_rows<std::uint8_t>("/VTKHDF/Types", both("/VTKHDF/Types", 1), 2);
            file.virtual_rows<std::int64_t>("/VTKHDF/Connectivity", both("/VTKHDF/Connectivity", 4), 8);
            file.virtual_rows<std::int64_t>("/VTKHDF/Offsets", both("/VTKHDF/Offsets", 2), 4);
            file.virtual_rows<double>("/VTKHDF/PointData/p", of_field, rows);
        }
        return read(folder_.file("case/a.vtkhdf"));
    }
    void expect_error(const std::vector<Hdf5Writer::RowsElsewhere>& of_field,
                      const std::vector<std::string>& words) const {
        const auto result = read_main(of_field);
        ASSERT_FALSE(result);
        for (const std::string& word : words)
            EXPECT_NE(result.error().message.find(word), std::string::npos) << result.error().message;
    }
    const std::string p_ = "/VTKHDF/PointData/p";
    TemporaryFolder folder_;
};

TEST_F(ReadVirtualVtkhdf, ReadsPartsInFilesOfTheirOwn) {
    const auto result = read_main(both(p_, 4));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_TRUE(result->info.left_out.empty());
    EXPECT_EQ(result->info.files.size(), 3u);
    ASSERT_EQ(result->grid.cells.count(), 2u);
    EXPECT_EQ(numbers_of(result->grid.cells.connectivity), (std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7}));
    EXPECT_EQ(numbers_of(result->grid.point_fields.at(0).values), (std::vector<double>{0, 1, 2, 3, 10, 11, 12, 13}));
    EXPECT_EQ(result->grid.points.at(5, 0), 11);
}

TEST_F(ReadVirtualVtkhdf, AnEmptyPartHasARowOfOffsetsThatIsNowhere) {
    {
        Hdf5Writer file(folder_.file("case/none.vtkhdf"));
        file.data<std::int64_t>("/n", {0}, {1});
    }
    ASSERT_TRUE(read_main(both(p_, 4)));
    {
        const std::vector<std::string> counts = {"/VTKHDF/NumberOfPoints", "/VTKHDF/NumberOfCells",
                                                 "/VTKHDF/NumberOfConnectivityIds"};
        Hdf5Writer file(folder_.file("case/a.vtkhdf"), {counts[0], counts[1], counts[2], "/VTKHDF/Offsets"});
        for (const std::string& name : counts)
            file.virtual_rows<std::int64_t>(
                name, {{name_of(0), name, 1, 0}, {"none.vtkhdf", "/n", 1, 1}, {name_of(1), name, 1, 2}}, 3);
        const std::string offsets = "/VTKHDF/Offsets";
        file.virtual_rows<std::int64_t>(offsets, {{name_of(0), offsets, 2, 0}, {name_of(1), offsets, 2, 3}}, 5);
    }
    const auto result = read(folder_.file("case/a.vtkhdf"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(numbers_of(result->grid.cells.connectivity), (std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7}));
}

TEST_F(ReadVirtualVtkhdf, WhatIsMissingIsAnErrorThatNamesIt) {
    expect_error({{name_of(0), p_, 4, 0}, {"gone.vtkhdf", p_, 4, 4}}, {p_, "\"gone.vtkhdf\", which is not there"});
    expect_error({{name_of(0), p_, 4, 0}, {name_of(1), "/q", 4, 4}}, {p_, "\"/q\"", name_of(1), "cannot open"});
    expect_error({{name_of(0), p_, 4, 0}}, {p_, "without row 4"});
    expect_error({{name_of(0), p_, 4, 0}, {name_of(1), p_, 4, 2}}, {p_, "row 2 twice"});
    expect_error({{name_of(0), "/VTKHDF/Offsets", 4, 0}, {name_of(1), p_, 4, 4}}, {p_, "fewer values"});
}

TEST_F(ReadVirtualVtkhdf, FilesOutsideAndThoseOfThoseAreNotRead) {
    std::filesystem::copy_file(folder_.file("case/" + name_of(1)), folder_.file("outside.vtkhdf"));
    expect_error({{name_of(0), p_, 4, 0}, {"../outside.vtkhdf", p_, 4, 4}},
                 {p_, "../outside.vtkhdf", "only files below"});
    std::filesystem::create_symlink(folder_.file("outside.vtkhdf"), folder_.file("case/link.vtkhdf"));
    expect_error({{name_of(0), p_, 4, 0}, {"link.vtkhdf", p_, 4, 4}}, {"link.vtkhdf", "only files below"});
    {
        Hdf5Writer file(folder_.file("case/again.vtkhdf"));
        file.virtual_rows<double>("/p", {{name_of(1), p_, 4, 0}}, 4);
        file.virtual_rows<double>("/q", {{"../outside.vtkhdf", p_, 4, 0}}, 4);
    }
    expect_error({{name_of(0), p_, 4, 0}, {"again.vtkhdf", "/p", 4, 4}}, {"again.vtkhdf", "only files below"});
    { Hdf5Writer file(folder_.file("case/again.vtkhdf"), {"/q"}); }
    expect_error({{name_of(0), p_, 4, 0}, {"again.vtkhdf", "/p", 4, 4}}, {p_, "again.vtkhdf", "virtual itself"});
    expect_error({{".", p_, 4, 0}, {name_of(1), p_, 4, 4}}, {p_, "virtual itself"});
}

} // namespace
} // namespace isotet::test
