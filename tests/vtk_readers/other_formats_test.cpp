// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// EnSight Gold and VTKHDF.
#include <algorithm>
#include <filesystem>

#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "vtk_readers/hdf5_writer.hpp"
#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

std::string data_file(const std::string& name) { return (source_folder() / "data" / name).string(); }

std::string ensight_geometry() {
    return "made for a test\nline two\nnode id off\nelement id "
           "off\npart\n1\nsolid\ncoordinates\n5\n0\n1\n0\n0\n0\n0\n0\n1\n0\n0\n0\n0\n0\n1\n-1\n"
           "tetra4\n2\n1 2 3 4\n1 3 2 5\n";
}
const std::string ensight_case =
    "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\nVARIABLE\nscalar per node: temp temp.scl\n";

TEST(ReadEnsight, GivesPartsAndVariables) {
    const TemporaryFolder folder;
    folder.write("grid.geo", ensight_geometry());
    folder.write("temp.scl", "values\npart\n1\ncoordinates\n1\n2\n3\n4\n5\n");
    const auto result = read(folder.write("a.case", ensight_case));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.format, "ensight");
    EXPECT_EQ(result->grid.points.tuples(), 5u);
    EXPECT_EQ(result->grid.cells.count(), 2u);
    ASSERT_EQ(result->grid.point_fields.size(), 1u);
    EXPECT_EQ(result->grid.point_fields[0].name, "temp");
    EXPECT_EQ(result->grid.point_fields[0].values.at(4), 5);
}

/// Two parts with a tet each, the second one moved.
std::string two_parts() {
    const auto part = [](int number, const std::string& name, const char* z) {
        return "part\n" + std::to_string(number) + "\n" + name + "\ncoordinates\n4\n0\n1\n0\n0\n0\n0\n1\n0\n0\n0\n0\n" +
               z + "\ntetra4\n1\n1 2 3 4\n";
    };
    return "made for a test\nline two\nnode id off\nelement id off\n" + part(1, "solid", "1") + part(2, "fluid", "5");
}

TEST(ReadEnsight, ReadsThePartThatIsAskedFor) {
    const TemporaryFolder folder;
    folder.write("grid.geo", two_parts());
    const std::string path = folder.write("a.case", "FORMAT\ntype: ensight gold\nGEOMETRY\nmodel: grid.geo\n");
    const auto info = inspect(path);
    ASSERT_TRUE(info) << info.error().message;
    ASSERT_EQ(info->blocks.size(), 2u);
    EXPECT_EQ(info->blocks[1].name, "fluid");
    EXPECT_EQ(info->blocks[1].kind, "part");
    EXPECT_EQ(info->blocks[1].cells, 1u);
    ReadOptions options;
    for (const char* asked : {"fluid", "2"}) {
        options.blocks = {asked};
        const auto result = read(path, options);
        ASSERT_TRUE(result) << result.error().message;
        ASSERT_EQ(result->grid.cells.count(), 1u);
        EXPECT_EQ(result->grid.points.at(3, 2), 5);
    }
    options.blocks = {"gas"};
    const auto unknown = read(path, options);
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message.find("which has 1 'solid', 2 'fluid'"), std::string::npos)
        << unknown.error().message;
}

/// A CGNS file with its base a second time, as "Other".
std::string with_two_bases(const TemporaryFolder& folder) {
    std::string path = folder.file("two.cgns");
    std::filesystem::copy_file(data_file("cgns/wall_distance_hdf5.cgns"), path);
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    std::string base;
    H5Literate(
        file, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr,
        [](hid_t group, const char* name, const H5L_info_t*, void* found) -> herr_t {
            if (std::string(name).starts_with(" ") || std::string(name) == "CGNSLibraryVersion") return 0;
            const hid_t node = H5Oopen(group, name, H5P_DEFAULT);
            if (H5Aexists(node, "label") > 0) *static_cast<std::string*>(found) = name;
            H5Oclose(node);
            return 0;
        },
        &base);
    EXPECT_EQ(H5Ocopy(file, base.c_str(), file, "Other", H5P_DEFAULT, H5P_DEFAULT), 0);
    const hid_t copy = H5Oopen(file, "Other", H5P_DEFAULT), name = H5Aopen(copy, "name", H5P_DEFAULT);
    const std::vector<char> text = [] {
        std::vector<char> padded(33, '\0');
        std::ranges::copy(std::string("Other"), padded.begin());
        return padded;
    }();
    const hid_t type = H5Aget_type(name);
    EXPECT_EQ(H5Awrite(name, type, text.data()), 0);
    H5Tclose(type);
    H5Aclose(name);
    H5Oclose(copy);
    H5Fclose(file);
    return path;
}

TEST(ReadCgns, ReadsTheFirstBaseAndOthersWhenAsked) {
    const TemporaryFolder folder;
    const std::string path = with_two_bases(folder);
    const auto alone = read(data_file("cgns/wall_distance_hdf5.cgns"));
    const auto info = inspect(path);
    ASSERT_TRUE(alone && info);
    ASSERT_EQ(info->blocks.size(), 2 * alone->info.blocks.size());
    EXPECT_EQ(info->blocks[0].kind, "zone");
    EXPECT_TRUE(info->blocks.back().name.starts_with("Other/")) << info->blocks.back().name;

    const auto first = read(path);
    ASSERT_TRUE(first) << first.error().message;
    EXPECT_EQ(first->grid.cells.count(), alone->grid.cells.count());
    ASSERT_FALSE(first->notes.empty());
    EXPECT_NE(first->notes[0].find("only the first of 2 bases is read"), std::string::npos) << first->notes[0];

    ReadOptions options;
    for (const std::string& asked :
         {std::string("Other"), info->blocks.back().name, std::to_string(info->blocks.back().number)}) {
        options.blocks = {asked};
        const auto other = read(path, options);
        ASSERT_TRUE(other) << other.error().message;
        EXPECT_EQ(other->grid.cells.count(), alone->grid.cells.count()) << asked;
        EXPECT_TRUE(other->notes.empty() || other->notes[0].find("bases") == std::string::npos);
    }
}

TEST(ReadBlocks, OfAFormatWithoutThemAreAnError) {
    ReadOptions options;
    options.blocks = {"1"};
    const auto result = read(data_file("vtu/wall_distance_point.vtu"), options);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
    EXPECT_NE(result.error().message.find("has no blocks"), std::string::npos) << result.error().message;
}

TEST(ReadEnsight, RefusesFilesOutsideItsFolder) {
    const TemporaryFolder folder;
    folder.write("grid.geo", ensight_geometry());
    for (const char* name : {"../grid.geo", "/etc/passwd"}) {
        std::string text = ensight_case;
        text.replace(text.find("grid.geo"), 8, name);
        const auto result = read(folder.write("case/a.case", text));
        ASSERT_FALSE(result);
        EXPECT_NE(result.error().message.find("only files below"), std::string::npos) << result.error().message;
    }
}

TEST(ReadVtkhdf, GivesPointsCellsAndFields) {
    const TemporaryFolder folder;
    {
        Hdf5Writer file(folder.file("a.hdf"));
        write_two_tets(file);
        file.data<double>("/VTKHDF/PointData/p", {1, 2, 3, 4, 5}, {5});
        file.data<float>("/VTKHDF/CellData/c", {1, 2}, {2});
    }
    const auto result = read(folder.file("a.hdf"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.format, "vtkhdf");
    EXPECT_EQ(result->grid.points.tuples(), 5u);
    EXPECT_EQ(result->grid.cells.count(), 2u);
    EXPECT_EQ(result->grid.point_fields.at(0).values.at(4), 5);
    EXPECT_EQ(result->grid.cell_fields.at(0).values.type(), ScalarType::float32);
    const std::string content = content_of(folder.file("a.hdf"));
    for (std::size_t length = 64; length < content.size(); length += content.size() / 20)
        EXPECT_FALSE(read(folder.write("cut.hdf", content.substr(0, length)))) << length;
}

} // namespace
} // namespace isotet::test
