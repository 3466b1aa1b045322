// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sorting by keys says the same as the library's stable sort, whatever the keys are like.
#include <algorithm>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "base/parallel.hpp"
#include "base/radix_sort.hpp"
#include "support/seeds.hpp"

namespace isotet::test {
namespace {

using core::Keyed;

void expect_sorted(std::size_t n, const std::function<std::uint64_t(std::size_t)>& key_of) {
    std::vector<Keyed> items(n), scratch(n);
    for (std::size_t i = 0; i < n; ++i) items[i] = {key_of(i), i};
    std::vector<Keyed> expected = items;
    std::stable_sort(expected.begin(), expected.end(), [](const Keyed& a, const Keyed& b) { return a.key < b.key; });
    core::radix_sort(items, scratch);
    const auto same = [](const Keyed& a, const Keyed& b) { return a.key == b.key && a.number == b.number; };
    EXPECT_TRUE(std::equal(items.begin(), items.end(), expected.begin(), same)) << n << " items";
}

constexpr std::size_t sizes[] = {0, 1, 2, 24, 25, 1000, 70'000, (1 << 18) + 1, 1'000'000 / seed_share};

TEST(RadixSort, SortsEvenlySpreadKeysLikeTheStableSort) {
    std::mt19937_64 random(1);
    for (const std::size_t n : sizes) expect_sorted(n, [&](std::size_t) { return random() >> 1; });
}

TEST(RadixSort, KeepsTheOrderOfEqualKeys) {
    std::mt19937_64 random(2);
    for (const std::size_t n : sizes) {
        expect_sorted(n, [](std::size_t) { return 7; });
        expect_sorted(n, [&](std::size_t) { return random() % 5 << 60; });
    }
}

TEST(RadixSort, SortsKeysThatCrowdInOnePlace) {
    std::mt19937_64 random(3);
    for (const std::size_t n : sizes) {
        expect_sorted(n, [&](std::size_t i) { return i % 1000 == 0 ? random() : random() % 100'000; });
        expect_sorted(n, [&](std::size_t) { return std::uint64_t{1} << random() % 64; });
        expect_sorted(n, [&](std::size_t i) { return n - i; });
    }
}

TEST(RadixSort, GivesTheSameForAnyNumberOfThreads) {
    for (const int threads : {1, 2, 7})
        core::with_threads(threads, [] {
            std::mt19937_64 random(4);
            expect_sorted(600'000, [&](std::size_t) { return random() % 10'000'000; });
        });
}

} // namespace
} // namespace isotet::test
