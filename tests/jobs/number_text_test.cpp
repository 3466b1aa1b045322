// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/number_text.hpp>

#include <cmath>

#include <gtest/gtest.h>

namespace isotet::jobs {
namespace {

TEST(Rounded, HasAsManyDigitsAsTellADifference) {
    EXPECT_EQ(rounded(13.0 / 60, 0.001), "0.216667");
    EXPECT_EQ(rounded(101325.42, 1e-3), "101325.42");
    EXPECT_EQ(rounded(-101325.42, 1000), "-101325");
    EXPECT_EQ(rounded(0, 1e-9), "0");
    EXPECT_EQ(rounded(1.5, 0), "1.5");
    EXPECT_EQ(rounded(1.5, NAN), "1.5");
}

TEST(ToldApart, GivesDifferentValuesDifferentTexts) {
    using Texts = std::vector<std::string>;
    EXPECT_EQ(told_apart({101325.6, 101325.4, 101325.41}), (Texts{"101325.6", "101325.4", "101325.41"}));
    EXPECT_EQ(told_apart({0.25, 0.5, 0.25}), (Texts{"0.25", "0.5", "0.25"}));
    const double next = std::nextafter(1e300, INFINITY);
    EXPECT_NE(told_apart({1e300, next})[0], told_apart({1e300, next})[1]);
    EXPECT_TRUE(told_apart({}).empty());
}

TEST(Counted, KnowsOneFromMany) {
    EXPECT_EQ(counted(0, "triangle"), "0 triangles");
    EXPECT_EQ(counted(1, "triangle"), "1 triangle");
    EXPECT_EQ(counted(12345, "cell"), "12,345 cells");
}

TEST(Shortest, ReadsBackAsTheSameDouble) {
    for (const double value : {0.1, 0.30000000000000004, 1e22, 5e-324, -1.7976931348623157e308, 101325.0}) {
        EXPECT_EQ(parse_number(shortest(value)), value);
    }
    EXPECT_EQ(shortest(1.0), "1");
    EXPECT_EQ(shortest(0.7), "0.7");
}

TEST(ParseNumber, TakesWholeDecimalTextOnly) {
    EXPECT_EQ(parse_number("+5e-1"), 0.5);
    for (const char* text : {"", "+", "+-1", "1,5", "1.5x", " 1", "0x10", "1e400", "--1"})
        EXPECT_FALSE(parse_number(text)) << text;
}

TEST(Grouped, PutsCommasBetweenThousands) {
    EXPECT_EQ(grouped(0), "0");
    EXPECT_EQ(grouped(999), "999");
    EXPECT_EQ(grouped(1000), "1,000");
    EXPECT_EQ(grouped(18446744073709551615U), "18,446,744,073,709,551,615");
}

TEST(ParseBytes, TakesDecimalUnits) {
    EXPECT_EQ(parse_bytes("1000"), 1000u);
    EXPECT_EQ(parse_bytes("1000B"), 1000u);
    EXPECT_EQ(parse_bytes("2GB"), 2'000'000'000u);
    EXPECT_EQ(parse_bytes("1.5 kb"), 1500u);
    EXPECT_EQ(parse_bytes("0.25MB"), 250'000u);
    EXPECT_EQ(parse_bytes("3 TB"), 3'000'000'000'000u);
    EXPECT_EQ(parse_bytes("18446744073709551615"), 18446744073709551615u);
    for (const char* text : {"", "B", "GB", "-1", "-1GB", "1.5", "2G", "2GiB", "1 PB", "99999999TB", "nanMB", "infMB"})
        EXPECT_FALSE(parse_bytes(text)) << text;
}

TEST(FormatBytes, ChangesUnitsAtAThousand) {
    EXPECT_EQ(format_bytes(999), "999 B");
    EXPECT_EQ(format_bytes(1000), "1.0 kB");
    EXPECT_EQ(format_bytes(999'960), "1.0 MB");
    EXPECT_EQ(format_bytes(2'500'000'000'000'000), "2500.0 TB");
}

} // namespace
} // namespace isotet::jobs
