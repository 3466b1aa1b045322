// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// AVS UCD, EnSight Gold and VTKHDF.
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "vtk_readers/hdf5_writer.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

const std::string ucd =
    "# a comment\n5 2 3 1 0\n10 0 0 0\n11 1 0 0\n12 1 1 0\n13 0 1 0\n7 0 0 1\n"
    "1 4 tet 10 11 12 7\n2 5 pyr 7 10 11 12 13\n"
    "2 1 2\ntemp, K\nflow, m/s\n10 1 2 3\n11 4 5 6\n12 7 8 9\n13 10 11 12\n7 13 14 15\n1 1\nload, N\n1 0.5\n2 1.5\n";

TEST(ReadUcd, GivesPointsCellsAndFields) {
    const TemporaryFolder folder;
    const auto result = read(folder.write("a.inp", ucd));
    ASSERT_TRUE(result) << result.error().message;
    const Grid& grid = result->grid;
    EXPECT_EQ(grid.points.tuples(), 5u);
    EXPECT_EQ(grid.cells.types.at(1), 14);
    const std::vector<double> corners = {0, 1, 2, 4, 0, 1, 2, 3, 4}; // the pyramid's apex comes last
    for (std::size_t i = 0; i < corners.size(); ++i) EXPECT_EQ(grid.cells.connectivity.at(i), corners[i]);
    ASSERT_EQ(grid.point_fields.size(), 2u);
    EXPECT_EQ(grid.point_fields[1].name, "flow");
    EXPECT_EQ(grid.point_fields[1].values.at(4, 1), 15);
    ASSERT_EQ(grid.cell_fields.size(), 2u);
    EXPECT_EQ(grid.cell_fields[1].name, "load");
    EXPECT_EQ(grid.cell_fields[1].values.at(1), 1.5);
}

TEST(ReadUcd, IsAnErrorForEveryTruncation) {
    const TemporaryFolder folder;
    for (std::size_t length = 20; length < ucd.size() - 3; length += 7)
        EXPECT_FALSE(read(folder.write("cut.inp", ucd.substr(0, length)))) << length;
}

TEST(ReadUcd, CountsThatAreNegativeOrHugeAreErrors) {
    const TemporaryFolder folder;
    for (const char* counts : {"-5 2 3 1 0", "5 9000000000000000000 3 1 0", "6 2 3 1 0", "5 2 4 1 0", "5 1 3 1 0"}) {
        std::string broken = ucd;
        broken.replace(broken.find("5 2 3 1 0"), 9, counts);
        ReadOptions options;
        options.format = "ucd"; // the name alone would not do: the content does not look like it any more
        EXPECT_FALSE(read(folder.write("broken.inp", broken), options)) << counts;
    }
}

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
