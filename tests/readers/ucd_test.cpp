// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// AVS UCD.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/read.hpp>

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

TEST(ReadUcd, IsRecognizedBehindCommentsAndEmptyLinesByBothEndings) {
    const TemporaryFolder folder;
    for (const char* name : {"a.inp", "a.avs"})
        for (const char* before : {"", "\n", "  # by hand\n\n# again\n \r\n"}) {
            const auto info = inspect(folder.write(name, before + ucd));
            ASSERT_TRUE(info) << info.error().message;
            EXPECT_EQ(info->format, "ucd");
        }
    const auto abaqus = inspect(folder.write("b.inp", "** made\n*HEADING\n*NODE\n1, 0, 0, 0\n"));
    ASSERT_FALSE(abaqus);
    EXPECT_NE(abaqus.error().message.find("Abaqus"), std::string::npos) << abaqus.error().message;
}

TEST(ReadUcd, PutsCellValuesToTheirNumbers) {
    const TemporaryFolder folder;
    const auto loads = [&](const std::string& values) {
        std::string text = ucd;
        text.replace(text.find("1 0.5\n2 1.5\n"), 12, values);
        const auto result = read(folder.write("a.inp", text));
        return result ? std::vector<double>{result->grid.cell_fields.at(1).values.at(0),
                                            result->grid.cell_fields.at(1).values.at(1)}
                      : std::vector<double>{};
    };
    EXPECT_EQ(loads("2 0.5\n1 1.5\n"), (std::vector<double>{1.5, 0.5}));
    EXPECT_EQ(loads("7 0.5\n8 1.5\n"), (std::vector<double>{0.5, 1.5})) << "numbers of their own: in order";
    EXPECT_TRUE(loads("1 0.5\n8 1.5\n").empty());
}

TEST(ReadUcd, LeavesOutArraysWithoutNameAndRepeatedOnes) {
    const TemporaryFolder folder;
    std::string text = ucd;
    text.replace(text.find("temp, K\nflow"), 12, ", K\nflow, x");
    const auto unnamed = read(folder.write("a.inp", text));
    ASSERT_TRUE(unnamed) << unnamed.error().message;
    ASSERT_EQ(unnamed->grid.point_fields.size(), 1u);
    EXPECT_EQ(unnamed->grid.point_fields[0].values.at(4, 1), 15);
    EXPECT_EQ(unnamed->info.left_out.size(), 1u);
    text.replace(text.find("2 1 2\n, K\nflow, x"), 17, "3 1 1 1\nflow\ntemp\nflow, x");
    const auto repeated = read(folder.write("a.inp", text));
    ASSERT_TRUE(repeated) << repeated.error().message;
    EXPECT_EQ(repeated->grid.point_fields.size(), 2u);
    EXPECT_EQ(repeated->info.left_out.at(0).reason, "an earlier one has the same name");
}

TEST(ReadUcd, ArraysOfOneNameBehindEachOtherAreComponentsOfOne) { // as deal.II writes vectors
    const TemporaryFolder folder;
    std::string text = ucd;
    text.replace(text.find("2 1 2\ntemp, K\nflow"), 18, "3 1 1 1\ntemp, K\nflow, m/s\nflow");
    const auto result = read(folder.write("a.inp", text));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_TRUE(result->info.left_out.empty());
    ASSERT_EQ(result->grid.point_fields.size(), 2u);
    EXPECT_EQ(result->grid.point_fields[0].values.components(), 1u);
    EXPECT_EQ(result->grid.point_fields[1].values.components(), 2u);
    EXPECT_EQ(result->grid.point_fields[1].values.at(1, 0), 5);
    EXPECT_EQ(result->grid.point_fields[1].values.at(1, 1), 6);
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

} // namespace
} // namespace isotet::test
