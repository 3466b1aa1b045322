// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Isovalues within a range.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <isotet/isovalues.hpp>

namespace isotet::test {
namespace {

using Levels = std::vector<double>;
constexpr double max_double = std::numeric_limits<double>::max();

TEST(Levels, DivideARangeIntoEqualParts) {
    EXPECT_EQ(evenly_spaced_levels(1, 9, 3), (Levels{3, 5, 7}));
    EXPECT_EQ(evenly_spaced_levels(-2, -1, 1), (Levels{-1.5}));
}

TEST(Levels, OfNoRangeAreNone) {
    EXPECT_TRUE(evenly_spaced_levels(2, 1, 3).empty());
    EXPECT_TRUE(evenly_spaced_levels(0, INFINITY, 3).empty());
    EXPECT_TRUE(evenly_spaced_levels(NAN, 1, 3).empty());
    EXPECT_TRUE(evenly_spaced_levels(0, 1, 0).empty());
}

TEST(Levels, OfOneValueAreThatValue) {
    EXPECT_EQ(evenly_spaced_levels(5, 5, 2), (Levels{5, 5}));
    EXPECT_EQ(evenly_spaced_levels(5, 5, 2, LevelRounding::short_decimals), (Levels{5}));
}

TEST(Levels, StayFiniteWhereTheDifferenceIsNot) {
    for (const LevelRounding rounding : {LevelRounding::none, LevelRounding::short_decimals})
        for (const double level : evenly_spaced_levels(-max_double, max_double, 7, rounding))
            EXPECT_TRUE(std::isfinite(level));
    EXPECT_EQ(evenly_spaced_levels(-max_double, max_double, 1), (Levels{0}));
}

TEST(Levels, AreShortDecimalsWhenRounded) {
    EXPECT_EQ(evenly_spaced_levels(0.0123, 0.4061, 3, LevelRounding::short_decimals), (Levels{0.111, 0.209, 0.308}));
    const Levels large = evenly_spaced_levels(101325, 101425, 3, LevelRounding::short_decimals);
    EXPECT_EQ(large, (Levels{101350, 101375, 101400}));
}

} // namespace
} // namespace isotet::test
