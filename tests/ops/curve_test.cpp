// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The Hilbert curve passes through every cell of a cube once, from neighbour to neighbour.
#include <algorithm>
#include <cstdlib>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "numbers/hilbert.hpp"

namespace isotet::test {
namespace {

struct Cell {
    std::uint64_t index;
    int x, y, z;
};

/// The cells of an aligned cube, along the curve.
std::vector<Cell> cells_along_curve(std::uint32_t x0, std::uint32_t y0, std::uint32_t z0, std::uint32_t side) {
    std::vector<Cell> cells;
    for (std::uint32_t x = x0; x < x0 + side; ++x)
        for (std::uint32_t y = y0; y < y0 + side; ++y)
            for (std::uint32_t z = z0; z < z0 + side; ++z)
                cells.push_back(
                    {core::hilbert_index(x, y, z), static_cast<int>(x), static_cast<int>(y), static_cast<int>(z)});
    std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) { return a.index < b.index; });
    return cells;
}

TEST(HilbertCurve, VisitsEveryCellOfAnAlignedCubeOnceFromNeighbourToNeighbour) {
    constexpr std::uint32_t side = 16;
    std::mt19937 random(1);
    for (int round = 0; round < 20; ++round) {
        const auto corner = [&] { return random() % ((1u << 21) / side) * side; };
        const auto cells =
            round == 0 ? cells_along_curve(0, 0, 0, side) : cells_along_curve(corner(), corner(), corner(), side);
        for (std::size_t i = 1; i < cells.size(); ++i) {
            ASSERT_EQ(cells[i].index, cells[i - 1].index + 1);
            ASSERT_EQ(std::abs(cells[i].x - cells[i - 1].x) + std::abs(cells[i].y - cells[i - 1].y) +
                          std::abs(cells[i].z - cells[i - 1].z),
                      1);
        }
    }
}

TEST(HilbertCurve, StartsInOneCornerAndUsesAll63Bits) {
    EXPECT_EQ(core::hilbert_index(0, 0, 0), 0u);
    constexpr std::uint32_t last = (1u << 21) - 1;
    std::uint64_t highest = 0;
    for (const std::uint32_t x : {0u, last})
        for (const std::uint32_t y : {0u, last})
            for (const std::uint32_t z : {0u, last}) highest = std::max(highest, core::hilbert_index(x, y, z));
    EXPECT_EQ(highest, (std::uint64_t{1} << 63) - 1);
}

} // namespace
} // namespace isotet::test
