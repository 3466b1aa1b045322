// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The CPU engine against the reference, byte for byte, on random nasty grids.
#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/engines.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

void expect_engines_agree(std::uint32_t seed, const NastyOptions& nasty, Precision precision,
                          const std::vector<double>& isovalues) {
    const NastyGrid g = nasty_grid(seed, nasty);
    PackOptions pack_options;
    pack_options.precision = precision;
    pack_options.source_cells = true;
    pack_options.gradients = true;
    const PackedGrid packed = pack(g.grid, g.field, pack_options).value();
    for (const double isovalue : isovalues)
        for (const Ties ties : {Ties::merge, Ties::keep}) {
            ExtractOptions options;
            options.ties = ties;
            options.normals = Normals::gradient;
            options.edge_ends = true;
            options.source_cells = true;
            options.point_fields = {{"value", g.field.values}};
            const Extraction cpu = extract(packed, isovalue, options).value();
            const Extraction reference = extract_on(Engine::reference, packed, isovalue, options).value();
            ASSERT_EQ(cpu.surface.vertex_count(), reference.surface.vertex_count())
                << "seed " << seed << ", isovalue " << isovalue << ", ties " << int(ties);
            ASSERT_EQ(cpu.surface.triangle_count(), reference.surface.triangle_count())
                << "seed " << seed << ", isovalue " << isovalue << ", ties " << int(ties);
            ASSERT_TRUE(bytes_of(cpu.surface) == bytes_of(reference.surface))
                << "seed " << seed << ", isovalue " << isovalue << ", ties " << int(ties);
            ASSERT_EQ(cpu.report.selected_clusters, reference.report.selected_clusters);
            ASSERT_EQ(cpu.report.tied_points, reference.report.tied_points);
        }
}

TEST(EnginesAgree, OnSmoothFields) {
    for (const std::uint32_t seed : Seeds(1, 4))
        expect_engines_agree(seed, {.side = 11, .values = 0}, Precision::float32, {-2, -0.4, 0, 0.3, 2});
}

TEST(EnginesAgree, OnIntegerFieldsFullOfTies) {
    for (const std::uint32_t seed : Seeds(1, 12))
        expect_engines_agree(seed, {.side = 4 + int(seed) % 6, .values = 2 + int(seed) % 4}, Precision::float32,
                             {-1, 0, 0.5, 1, 2});
}

TEST(EnginesAgree, OnPointsWithoutData) {
    for (const std::uint32_t seed : Seeds(1, 12))
        expect_engines_agree(seed, {.side = 4 + int(seed) % 6, .values = 4, .no_data = 0.05 * (seed % 5)},
                             Precision::float32, {-1, 0, 1, 1.5});
}

TEST(EnginesAgree, OnTangledGridsWithRepeatedAndMissingTets) {
    for (const std::uint32_t seed : Seeds(1, 12))
        expect_engines_agree(seed,
                             {.side = 4 + int(seed) % 6,
                              .values = 3,
                              .no_data = 0.03,
                              .missing = 0.2,
                              .inverted = 0.2,
                              .mirrored = 0.5,
                              .repeated = 0.1},
                             Precision::float32, {0, 0.5, 1});
}

TEST(EnginesAgree, OnDoublePacking) {
    for (const std::uint32_t seed : Seeds(1, 6))
        expect_engines_agree(seed, {.side = 7, .values = int(seed % 2) * 4, .no_data = 0.02, .wide = true},
                             Precision::float64, {0, 0.25, 1});
}

} // namespace
} // namespace isotet::test
