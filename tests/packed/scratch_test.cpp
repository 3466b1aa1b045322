// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Packing with its arrays in files gives the file of packing in memory.
#include <gtest/gtest.h>

#include <isotet/memory.hpp>

#include "packed/packed_samples.hpp"

namespace isotet::test {
namespace {

/// The files of all kinds of grids, large enough that some of their arrays are large blocks.
std::vector<std::string> sample_files(const TemporaryFolder& folder) {
    std::vector<std::string> files;
    const auto add = [&](const Grid& grid, const PointField& field, Precision precision) {
        files.push_back(content_of(saved(pack(grid, field, packing_of_all(precision)).value(), folder)));
    };
    NastyOptions tets;
    tets.side = 14;
    tets.no_data = 0.05;
    tets.repeated = tets.missing = 0.1;
    const NastyGrid ties = nasty_grid(1, tets);
    add(ties.grid, ties.field, Precision::float32);
    MixedOptions others;
    others.side = 14;
    others.no_data = 0.03;
    others.values = 0;
    others.wide = true;
    const NastyGrid mixed = mixed_grid(4, others);
    add(mixed.grid, mixed.field, Precision::float64);
    const Grid hexahedra = made_grid("hex", 24, {"gyroid"});
    add(hexahedra, point_field(hexahedra), Precision::float32);
    return files;
}

TEST(PackingInScratchFiles, GivesTheSameFileForAllKindsOfGrids) {
    const TemporaryFolder folder;
    const std::vector<std::string> expected = sample_files(folder);
    const ScratchMemory scratch = ScratchMemory::begin({folder.file(""), 1}).value();
    EXPECT_TRUE(sample_files(folder) == expected);
    EXPECT_GT(scratch.report().peak_bytes, 0u);
}

TEST(PackingInScratchFiles, GivesTheSameFileForAnyLimitAndThreads) {
    const TemporaryFolder folder;
    const auto file = [&](int threads) {
        const Grid grid = made_grid("shuffled", 16, {"gyroid"});
        return content_of(saved(pack(grid, point_field(grid), {}, {.threads = threads}).value(), folder));
    };
    const std::string expected = file(2);
    for (const std::uint64_t memory : {std::uint64_t{1}, std::uint64_t{6'000'000}, std::uint64_t{1} << 40})
        for (const int threads : {1, 4}) {
            const ScratchMemory scratch = ScratchMemory::begin({folder.file(""), memory}).value();
            EXPECT_TRUE(file(threads) == expected) << memory << ' ' << threads;
            EXPECT_EQ(scratch.report().peak_bytes > 0, memory < (std::uint64_t{1} << 40));
        }
}

} // namespace
} // namespace isotet::test
