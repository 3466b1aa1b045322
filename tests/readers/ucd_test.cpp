// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// AVS UCD.
#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <vector>

#include <fmt/core.h>
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
    for (const char* name : {"a.inp", "a.avs", "a.ucd"})
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

/// Four bytes each, in one of the orders.
class BinaryText {
public:
    explicit BinaryText(std::endian order) : order_(order) {}
    template <class Number>
    void put(std::initializer_list<Number> numbers) {
        for (const Number number : numbers) {
            auto bytes = std::bit_cast<std::array<char, 4>>(number);
            if (order_ != std::endian::native) std::ranges::reverse(bytes);
            text.append(bytes.data(), bytes.size());
        }
    }
    void put_label(std::string label) {
        label.resize(1024);
        text += label;
    }
    std::string text = "\x07";

private:
    std::endian order_;
};

/// The grid of `ucd`, with another cell field. VTK 9.7 reads the same of it.
std::string binary_ucd(std::endian order) {
    BinaryText file(order);
    file.put({5, 2, 3, 3, 1, 9});
    file.put({1, 4, 4, 4, 2, 5, 5, 5}); // number, material, corners, type
    file.put({1, 2, 3, 5, 5, 1, 2, 3, 4});
    file.put({0.F, 1.F, 1.F, 0.F, 0.F, 0.F, 0.F, 1.F, 1.F, 0.F, 0.F, 0.F, 0.F, 0.F, 1.F});
    file.put_label("temp.flow.");
    file.put_label("K.m/s.");
    file.put({2, 1, 2, 0});
    file.put({0.F, 0.F, 0.F, 9.F, 9.F, 9.F});
    file.put({1.F, 4.F, 7.F, 10.F, 13.F, 2.F, 3.F, 5.F, 6.F, 8.F, 9.F, 11.F, 12.F, 14.F, 15.F});
    file.put({1, 1, 1});
    file.put_label("load.moment");
    file.put_label("N.Nm");
    file.put({2, 1, 2, 0});
    file.put({0.F, 0.F, 0.F, 9.F, 9.F, 9.F});
    file.put({0.5F, 1.5F, 1.F, 2.F, 3.F, 4.F});
    file.put({1, 1, 1});
    file.put_label("model");
    file.put_label("");
    file.put({1, 1, 0, 0, 0, 0});
    return file.text;
}

TEST(ReadBinaryUcd, IsReadInBothOrders) {
    const TemporaryFolder folder;
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        const auto result = read(folder.write("a.inp", binary_ucd(order)));
        ASSERT_TRUE(result) << result.error().message;
        const Grid& grid = result->grid;
        EXPECT_EQ(grid.points.tuples(), 5u);
        EXPECT_EQ(grid.points.at(2, 1), 1);
        const std::vector<double> corners = {0, 1, 2, 4, 0, 1, 2, 3, 4};
        for (std::size_t i = 0; i < corners.size(); ++i) EXPECT_EQ(grid.cells.connectivity.at(i), corners[i]);
        ASSERT_EQ(grid.point_fields.size(), 2u);
        EXPECT_EQ(grid.point_fields[0].values.at(4), 13);
        EXPECT_EQ(grid.point_fields[1].name, "flow");
        EXPECT_EQ(grid.point_fields[1].values.at(4, 1), 15);
        ASSERT_EQ(grid.cell_fields.size(), 3u);
        EXPECT_EQ(grid.cell_fields[0].values.at(1), 5);
        EXPECT_EQ(grid.cell_fields[1].values.at(1), 1.5);
        EXPECT_EQ(grid.cell_fields[2].name, "moment");
        EXPECT_EQ(grid.cell_fields[2].values.at(1, 1), 4);
        ReadOptions one;
        one.point_fields = {"flow"};
        one.cell_fields.emplace();
        const auto wanted = read(folder.file("a.inp"), one);
        ASSERT_TRUE(wanted) << wanted.error().message;
        ASSERT_EQ(wanted->grid.point_fields.size(), 1u);
        EXPECT_EQ(wanted->grid.point_fields[0].values.at(4, 1), 15);
        EXPECT_EQ(inspect(folder.file("a.inp")).value().fields.size(), 5u);
    }
}

TEST(ReadBinaryUcd, WhatDoesNotFitIsAnError) {
    const TemporaryFolder folder;
    const std::string sound = binary_ucd(std::endian::little);
    const auto message = [&](std::size_t number, char value) {
        std::string text = sound;
        text[1 + 4 * number] = value;
        const auto result = read(folder.write("a.inp", text));
        return result ? "read" : result.error().message;
    };
    const auto expect = [](const std::string& text, const std::string& part) {
        EXPECT_NE(text.find(part), std::string::npos) << text;
    };
    expect(message(0, 6), fmt::format("has {} bytes, but its header announces {}", sound.size(), sound.size() + 24));
    expect(message(9, 5), "has cell 0 of type 5 with 4 corners");
    expect(message(9, 8), "has cell 0 of type 8 with 4 corners");
    expect(message(14, 6), "has cell 0 with point 6, but the points are 1 to 5");
    expect(message(14, 0), "has cell 0 with point 0");
    const std::size_t arrays = 38 + 2 * 256;
    expect(message(arrays, 4), "has 4 arrays of 3 values");
    expect(message(arrays, 1), "has arrays of 1 values, but 3 are announced");
    expect(message(arrays + 2, 3), "has arrays of 4 values, but 3 are announced");
    for (std::size_t length = 1; length < sound.size(); length += 101)
        EXPECT_FALSE(read(folder.write("cut.inp", sound.substr(0, length)))) << length;
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
