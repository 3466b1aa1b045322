// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is dealt out into buckets comes back: by writer first, then, sorted, by number.
#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "packed/build/ranked_buckets.hpp"

namespace isotet::test {
namespace {

using core::RankedTet;
using core::RankedBuckets;
using core::CellOrigin;

struct Dealt {
    RankedTet tet;
    std::uint64_t origin;
    friend bool operator==(const Dealt&, const Dealt&) = default;
};

void expect_everything_comes_back(std::size_t ranks, std::size_t tets, std::size_t writers) {
    std::mt19937 random(3);
    RankedBuckets<RankedTet> buckets(ranks, tets, writers, true);
    std::vector<std::vector<Dealt>> expected(buckets.buckets());
    for (std::size_t w = 0; w < writers; ++w) {
        RankedBuckets<RankedTet>::Writer writer(buckets, w);
        for (std::size_t i = tets / writers * w; i < tets / writers * (w + 1); ++i) {
            RankedTet tet;
            for (std::uint32_t& rank : tet) rank = static_cast<std::uint32_t>(random() % ranks);
            writer.put(tet, core::lowest_rank(tet), {i});
            expected[core::lowest_rank(tet) / buckets.ranks_per_bucket()].push_back({tet, i});
        }
    }
    std::vector<Dealt> all;
    for (std::size_t b = 0; b < buckets.buckets(); ++b) {
        std::vector<Dealt> found;
        buckets.for_dealt(b, [&](const RankedTet& tet, CellOrigin origin) { found.push_back({tet, origin.value}); });
        ASSERT_EQ(found, expected[b]);
        ASSERT_EQ(buckets.dealt(b), found.size());
        std::vector<RankedTet> sorted;
        std::vector<CellOrigin> origins;
        for (const Dealt& one : found) {
            if (one.origin % 7 == 0) continue; // some are dropped
            sorted.push_back(one.tet);
            origins.push_back({one.origin});
            all.push_back(one);
        }
        buckets.write_sorted(b, sorted, origins);
        for (std::size_t i = 0; i < sorted.size(); ++i) ASSERT_EQ(buckets.sorted(b, i), sorted[i]);
    }
    buckets.number();
    ASSERT_EQ(buckets.size(), all.size());
    for (std::size_t first = 0; first < all.size(); first += 1000) {
        std::vector<RankedTet> found(std::min<std::size_t>(1000, all.size() - first));
        std::vector<CellOrigin> origins(found.size());
        buckets.copy_items(first, found);
        buckets.copy_origins(first, origins);
        for (std::size_t i = 0; i < found.size(); ++i) {
            ASSERT_EQ(found[i], all[first + i].tet);
            ASSERT_EQ(origins[i].value, all[first + i].origin);
        }
    }
}

TEST(RankedBuckets, GiveBackWhatIsDealtOut) {
    expect_everything_comes_back(10, 5000, 1);
    expect_everything_comes_back(4096, 5000, 3);
    expect_everything_comes_back(60'000, 20'000, 7);
    expect_everything_comes_back(100'000, 600, 128); // hardly a tet for each page
}

} // namespace
} // namespace isotet::test
