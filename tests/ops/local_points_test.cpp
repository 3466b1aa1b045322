// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/pack.hpp>

#include "packed/local_values.hpp"
#include "support/random_grid.hpp"

namespace isotet::test {
namespace {

/// The headers and links of a grid, as if so many other points stood before its own.
core::Packed behind(const core::Packed& packed, std::uint64_t points) {
    core::Packed out;
    out.links = packed.links;
    out.headers = core::SharedBuffer<core::ClusterHeader>(packed.clusters());
    std::copy(packed.headers.begin(), packed.headers.end(), out.headers.begin());
    for (core::ClusterHeader& h : out.headers) h.first_point += points;
    return out;
}

TEST(LocalPoints, AreFoundOnEitherSideOfTheLargest32BitNumber) {
    const NastyGrid g = nasty_grid(3, {.side = 12});
    const PackedGrid grid = pack(g.grid, g.field).value();
    const core::Packed& packed = grid.data();
    ASSERT_GT(packed.clusters(), 4u);
    const std::uint64_t end = std::uint64_t{1} << 32;
    for (const std::uint64_t before : {end - packed.points(), end - packed.points() / 2, end, 5 * end}) {
        const core::Packed moved = behind(packed, before);
        for (std::size_t cluster = 0; cluster < packed.clusters(); ++cluster) {
            std::vector<std::uint64_t> expected(core::max_cluster_points);
            expected.resize(core::local_points(moved, cluster, expected.data()));
            core::LocalPoints points;
            points.find(moved, cluster);
            ASSERT_EQ(points.ghost(), packed.headers[cluster].ghost_points);
            for (std::size_t k = 0; k < expected.size(); ++k) ASSERT_EQ(points[k], expected[k]) << cluster;
        }
    }
}

} // namespace
} // namespace isotet::test
