// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From 2^32 vertices on, triangles have 64-bit indices. The limit is lowered here: the same triangles come out, wider.
#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "cpu/extract.hpp"
#include "support/random_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

/// Lowers the limit for one test.
class WideIndices : public testing::Test {
protected:
    void TearDown() override { cpu::wide_from = limit_; }

private:
    const std::uint64_t limit_ = cpu::wide_from;
};

TEST_F(WideIndices, GiveTheSameSurfaceAsNarrowOnes) {
    for (const Precision precision : {Precision::float32, Precision::float64})
        for (const Ties ties : {Ties::merge, Ties::keep}) {
            const NastyGrid g = nasty_grid(9, {.side = 8, .values = 3, .no_data = 0.02, .wide = true});
            PackOptions pack_options;
            pack_options.precision = precision;
            pack_options.gradients = pack_options.source_cells = true;
            const PackedGrid packed = pack(g.grid, g.field, pack_options).value();
            ExtractOptions options;
            options.ties = ties;
            options.normals = Normals::gradient;
            options.edge_ends = options.source_cells = true;
            const Surface narrow = extract(packed, 0.5, options).value().surface;
            cpu::wide_from = narrow.vertex_count();
            Surface wide = extract(packed, 0.5, options).value().surface;
            cpu::wide_from = narrow.vertex_count() + 1;
            EXPECT_EQ(extract(packed, 0.5, options).value().surface.triangles.type(), ScalarType::uint32);
            ASSERT_EQ(narrow.triangles.type(), ScalarType::uint32);
            ASSERT_EQ(wide.triangles.type(), ScalarType::uint64);
            const auto indices = wide.triangles.as<std::uint64_t>();
            wide.triangles = Array::own(std::vector<std::uint32_t>(indices.begin(), indices.end()), 3);
            EXPECT_TRUE(bytes_of(narrow) == bytes_of(wide));
        }
}

TEST_F(WideIndices, AreCheckedMeasuredAndGivenFaceNormalsAlike) {
    const NastyGrid g = nasty_grid(10, {.side = 8, .values = 0});
    const PackedGrid packed = pack(g.grid, g.field).value();
    ExtractOptions options;
    options.normals = Normals::face;
    const Surface narrow = extract(packed, 0.1, options).value().surface;
    cpu::wide_from = 1;
    const Surface wide = extract(packed, 0.1, options).value().surface;
    ASSERT_EQ(wide.triangles.type(), ScalarType::uint64);
    EXPECT_EQ(area(wide), area(narrow));
    EXPECT_EQ(check(wide).value().euler, check(narrow).value().euler);
    std::string narrow_normals, wide_normals;
    append_bytes(narrow_normals, narrow.normals);
    append_bytes(wide_normals, wide.normals);
    EXPECT_TRUE(narrow_normals == wide_normals);
}

} // namespace
} // namespace isotet::test
