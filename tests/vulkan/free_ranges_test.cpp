// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Ranges of a block: never overlapping, aligned, the lowest that fits, joined again.
#include <map>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "vulkan/free_ranges.hpp"

namespace isotet::test {
namespace {

using vulkan::FreeRanges;

TEST(FreeRanges, GiveTheLowestRangeThatFits) {
    FreeRanges ranges(1000);
    EXPECT_EQ(ranges.take(10, 1), 0u);
    EXPECT_EQ(ranges.take(10, 256), 256u);
    EXPECT_EQ(ranges.take(246, 1), 10u) << "the gap before an aligned range";
    EXPECT_EQ(ranges.take(734, 1), 266u);
    EXPECT_FALSE(ranges.take(1, 1));
    ranges.give_back(256, 10);
    EXPECT_FALSE(ranges.take(11, 1));
    EXPECT_EQ(ranges.take(10, 1), 256u);
}

TEST(FreeRanges, RefuseMoreThanThereIs) {
    FreeRanges ranges(1000);
    EXPECT_FALSE(ranges.take(1001, 1));
    EXPECT_FALSE(ranges.take(~std::uint64_t{0}, 256));
    EXPECT_EQ(ranges.take(1000, 256), 0u);
    EXPECT_FALSE(ranges.all_free());
    ranges.give_back(0, 1000);
    EXPECT_TRUE(ranges.all_free());
}

class RandomRanges : public testing::TestWithParam<unsigned> {};

TEST_P(RandomRanges, NeverOverlapAndAreWholeAgainAtTheEnd) {
    constexpr std::uint64_t size = 1 << 16;
    std::mt19937 random(GetParam());
    FreeRanges ranges(size);
    std::vector<int> owner(size, -1);
    std::map<int, std::pair<std::uint64_t, std::uint64_t>> taken;
    for (int step = 0; step < 3000; ++step) {
        if (!taken.empty() && random() % 5 < 2) {
            const auto one = std::next(taken.begin(), static_cast<std::ptrdiff_t>(random() % taken.size()));
            const auto [begin, bytes] = one->second;
            std::fill_n(owner.begin() + static_cast<std::ptrdiff_t>(begin), bytes, -1);
            ranges.give_back(begin, bytes);
            taken.erase(one);
            continue;
        }
        const std::uint64_t bytes = 1 + random() % 3000, alignment = std::uint64_t{1} << random() % 10;
        const auto begin = ranges.take(bytes, alignment);
        if (!begin) { // then no aligned run of so many free bytes exists
            for (std::uint64_t from = 0; from + bytes <= size; from += alignment) {
                const auto first = owner.begin() + static_cast<std::ptrdiff_t>(from);
                ASSERT_FALSE(
                    std::all_of(first, first + static_cast<std::ptrdiff_t>(bytes), [](int o) { return o == -1; }))
                    << "seed " << GetParam() << ", step " << step;
            }
            continue;
        }
        ASSERT_EQ(*begin % alignment, 0u);
        for (std::uint64_t i = *begin; i < *begin + bytes; ++i) {
            ASSERT_EQ(owner[i], -1) << "seed " << GetParam() << ", step " << step << ": byte " << i
                                    << " is given twice";
            owner[i] = step;
        }
        taken.emplace(step, std::pair(*begin, bytes));
    }
    for (const auto& [step, range] : taken) ranges.give_back(range.first, range.second);
    EXPECT_TRUE(ranges.all_free());
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomRanges, testing::Range(0u, 8u));

} // namespace
} // namespace isotet::test
