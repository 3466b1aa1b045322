// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Packing takes no more memory than is promised: allocations are counted.
#include <gtest/gtest.h>

#include <algorithm>

#include <isotet/pack.hpp>

#include "base/system/block.hpp"
#include "memory/counted_memory.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

double bytes_per_tet(const Grid& grid, int threads) {
    std::uint64_t tets = 0;
    const auto measure = [&] {
        core::drop_kept_blocks(); // what is kept from before would be used without being taken
        return peak_bytes(
            [&] { tets = pack(grid, point_field(grid), {}, {.threads = threads}).value().report().tets; });
    };
    // A worker thread that starts late takes memory of its own meanwhile, which is counted, too: so the lower of two.
    const std::size_t peak = std::min(measure(), measure());
    return static_cast<double>(peak) / static_cast<double>(tets);
}

TEST(PackingMemory, StaysBelowFortyBytesATet) {
    for (const char* shape : {"kuhn", "shuffled", "layer"}) {
        const Grid grid = made_grid(shape, 52, {"gyroid"}); // over 800,000 tets
        EXPECT_LE(bytes_per_tet(grid, 2), 40) << shape;
    }
}

TEST(PackingMemory, StaysBelowFortyBytesATetWithManyThreads) {
    EXPECT_LE(bytes_per_tet(made_grid("kuhn", 72, {"gyroid"}), 64), 40); // 34 blocks, over two million tets
}

} // namespace
} // namespace isotet::test
