// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Long lists in OpenFOAM's text files, parts of which are parsed side by side: the same as in order, and the same errors.
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/foam/scanner.hpp"

namespace isotet::test {
namespace {

using io::foam::Scanner;

Scanner scanner_of(const std::string& text) {
    auto owner = std::make_shared<const std::string>(text);
    const std::string_view view = *owner;
    return Scanner({"case/file", "file", std::move(owner), view});
}

/// 150,000 items or more make a few MB. With spaces, line ends and comments between them.
struct LongList {
    std::vector<std::int32_t> labels;
    std::vector<double> scalars, vectors;
    std::string text_of_labels, text_of_scalars, text_of_vectors, text_of_faces;
    std::vector<std::uint64_t> begins{0};
    std::vector<std::int32_t> points;

    LongList(int items, bool comments, const char* separator) {
        std::mt19937 random(3);
        for (int i = 0; i < items; ++i) {
            std::string between = separator;
            if (comments && random() % 1000 == 0) between += "// 7 (1 2 3) 4(0 1 2 3)\n";
            if (comments && random() % 1000 == 0) between += "/* 5\n(6 7 8) */ ";
            labels.push_back(static_cast<std::int32_t>(random() % 2'000'000'000));
            text_of_labels += fmt::format("{}{}", labels.back(), between);
            scalars.push_back(static_cast<double>(random()) / 1024);
            text_of_scalars += fmt::format("{}{}", scalars.back(), between);
            for (int k = 0; k < 3; ++k) vectors.push_back(static_cast<double>(random()) / -4096);
            const double* const v = vectors.data() + vectors.size() - 3;
            text_of_vectors += fmt::format("({} {} {}){}", v[0], v[1], v[2], between);
            const std::size_t size = 3 + random() % 3;
            text_of_faces += fmt::format("{}(", size);
            for (std::size_t k = 0; k < size; ++k) {
                points.push_back(static_cast<std::int32_t>(random() % 1'000'000));
                text_of_faces += fmt::format("{}{}", k == 0 ? "" : " ", points.back());
            }
            text_of_faces += ")" + between;
            begins.push_back(points.size());
        }
    }
    static std::string list(std::size_t stated, const std::string& items) {
        return fmt::format("{}\n(\n{})\n;\nnext 3 (4 5 6);\n", stated, items);
    }
};

TEST(FoamLists, ThatAreLongAreReadWhole) {
    for (const bool comments : {false, true})
        for (const char* separator : {"\n", "  ", "\t\r\n"}) {
            SCOPED_TRACE(fmt::format("{} comments, {:?}", comments ? "with" : "without", separator));
            const LongList made(150'000, comments, separator);
            const std::size_t count = made.labels.size();
            Scanner labels = scanner_of(LongList::list(count, made.text_of_labels));
            EXPECT_TRUE(labels.labels("labels", 0).value() == made.labels);
            EXPECT_EQ(labels.token(), ";");
            EXPECT_EQ(labels.token(), "next");
            Scanner scalars = scanner_of(LongList::list(count, made.text_of_scalars));
            EXPECT_TRUE(scalars.tuples(1, "scalars", 0).value() == made.scalars);
            EXPECT_EQ(scalars.token(), ";");
            Scanner vectors = scanner_of(LongList::list(count, made.text_of_vectors));
            EXPECT_TRUE(vectors.tuples(3, "vectors", 0).value() == made.vectors);
            EXPECT_EQ(vectors.token(), ";");
            Scanner faces = scanner_of(LongList::list(count, made.text_of_faces));
            const auto read = faces.faces();
            ASSERT_TRUE(read) << read.error().message;
            EXPECT_TRUE(read->begins == made.begins);
            EXPECT_TRUE(read->points == made.points);
            EXPECT_EQ(faces.token(), ";");
        }
}

TEST(FoamLists, OfFacesThatAreAlikeKeepNoBegins) {
    const auto alike = scanner_of("2\n(\n3(0 1 2)\n3(2 1 3)\n)\n").faces();
    ASSERT_TRUE(alike) << alike.error().message;
    EXPECT_TRUE(alike->begins.empty());
    EXPECT_EQ(alike->count(), 2u);
    EXPECT_TRUE(std::ranges::equal(alike->of(1), std::array{2, 1, 3}));
    const auto others = scanner_of("2\n(\n3(0 1 2)\n4(2 1 3 4)\n)\n").faces();
    ASSERT_TRUE(others) << others.error().message;
    EXPECT_EQ(others->count(), 2u);
    EXPECT_TRUE(std::ranges::equal(others->of(1), std::array{2, 1, 3, 4}));
}

TEST(FoamLists, ThatAreLongAndWrongAreErrorsWithTheirPlace) {
    const LongList made(300'000, false, "\n");
    const std::size_t count = made.labels.size();
    for (const std::size_t stated : {count - 1, count + 1}) {
        EXPECT_FALSE(scanner_of(LongList::list(stated, made.text_of_labels)).labels("labels", 0));
        EXPECT_FALSE(scanner_of(LongList::list(stated, made.text_of_scalars)).tuples(1, "scalars", 0));
        EXPECT_FALSE(scanner_of(LongList::list(stated, made.text_of_vectors)).tuples(3, "vectors", 0));
        EXPECT_FALSE(scanner_of(LongList::list(stated, made.text_of_faces)).faces());
    }
    std::string broken = made.text_of_labels;
    const std::size_t line = broken.find('\n', broken.size() / 2);
    broken.insert(line + 1, "x1\n");
    const auto labels = scanner_of(LongList::list(count + 1, broken)).labels("labels", 0);
    ASSERT_FALSE(labels);
    EXPECT_NE(labels.error().message.find("x1"), std::string::npos) << labels.error().message;
    const auto cut =
        scanner_of(LongList::list(count, made.text_of_faces).substr(0, made.text_of_faces.size() / 2)).faces();
    ASSERT_FALSE(cut);
    EXPECT_NE(cut.error().message.find("of face 1"), std::string::npos) << cut.error().message;
}

} // namespace
} // namespace isotet::test
