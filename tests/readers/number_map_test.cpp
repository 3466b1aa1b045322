// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/number_map.hpp"

#include <cstdint>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace isotet::test {
namespace {

using io::NumberMap;

constexpr std::int64_t lowest = std::numeric_limits<std::int64_t>::min(),
                       highest = std::numeric_limits<std::int64_t>::max();

void expect_positions(const std::vector<std::int64_t>& numbers, const std::vector<std::int64_t>& strangers) {
    NumberMap map;
    for (const std::int64_t number : numbers) map.add(number);
    ASSERT_TRUE(map.close("node"));
    EXPECT_EQ(map.size(), numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) EXPECT_EQ(map.find(numbers[i]), i) << numbers[i];
    for (const std::int64_t stranger : strangers) EXPECT_EQ(map.find(stranger), NumberMap::none) << stranger;
}

TEST(NumberMap, FindsNumbersThatCountUpByOne) { expect_positions({5, 6, 7, 8}, {4, 9, 0, -1, lowest, highest}); }

TEST(NumberMap, FindsDenseNumbersInAnyOrder) { expect_positions({5, 6, 3, 8, 12}, {4, 7, 2, 13, lowest, highest}); }

TEST(NumberMap, FindsSparseNumbers) {
    expect_positions({1, 2, highest, lowest, 0, 1000000000000}, {3, -1, 999999999999});
}

TEST(NumberMap, FindsNothingWhenNothingWasAdded) { expect_positions({}, {0, 1, -1}); }

TEST(NumberMap, RefusesNumbersThatOccurTwice) {
    for (const std::vector<std::int64_t>& numbers :
         {std::vector<std::int64_t>{1, 2, 1}, {1, 1}, {1, 99999999, 5, 99999999}}) {
        NumberMap map;
        for (const std::int64_t number : numbers) map.add(number);
        EXPECT_FALSE(map.close("node"));
    }
}

} // namespace
} // namespace isotet::test
