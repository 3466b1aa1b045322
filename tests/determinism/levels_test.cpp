// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The same bytes from portable code, AVX2 and AVX-512: as far as the machine goes, which the test prints.
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>

#include "core/level.hpp"
#include "determinism/packed_bytes.hpp"
#include "support/random_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

/// The reference's surface, from every level.
void expect_equal_levels(const PackedGrid& packed, double isovalue, ExtractOptions options) {
    options.engine = Engine::reference;
    const std::string expected = bytes_of(extract(packed, isovalue, options).value().surface);
    options.engine = Engine::cpu;
    for (int level = 0; level <= int(core::best_level()); ++level) {
        core::force_level(core::Level(level));
        const Extraction made = extract(packed, isovalue, options).value();
        core::force_level({});
        ASSERT_TRUE(bytes_of(made.surface) == expected)
            << "isovalue " << isovalue << ", " << core::name_of(core::Level(level));
    }
}

TEST(InstructionLevels, GiveTheSameBytes) {
    RecordProperty("best_level", std::string(core::name_of(core::best_level())));
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        const bool smooth = seed % 2;
        const NastyGrid g =
            nasty_grid(seed, {.side = 9, .values = smooth ? 0 : 5, .no_data = smooth ? 0 : 0.002, .missing = 0.05});
        const PackedGrid packed = pack(g.grid, g.field, {.source_cells = true, .gradients = true}).value();
        for (const double isovalue : {-0.5, 0.0, 0.25, 1.5})
            for (const bool extras : {false, true}) {
                ExtractOptions options;
                options.edge_ends = options.source_cells = extras;
                options.normals = extras ? Normals::gradient : Normals::none;
                SCOPED_TRACE(fmt::format("seed {}", seed));
                expect_equal_levels(packed, isovalue, options);
            }
    }
}

/// Noise cuts half of all edges, and clusters have more vertices than a byte can number.
TEST(InstructionLevels, GiveTheSameBytesOfNoise) {
    Grid grid = make_grid({.shape = "kuhn", .side = 12}).value();
    std::mt19937 random(1);
    std::vector<float> noise(grid.points.tuples());
    for (float& value : noise) value = std::uniform_real_distribution<float>(-1, 1)(random);
    PointField field;
    field.values = Array::own(std::move(noise));
    const PackedGrid packed = pack(grid, field).value();
    const Extraction made = extract(packed, 0).value();
    ASSERT_GT(made.surface.positions.tuples(), 200 * made.report.selected_clusters)
        << "own ones only: shared ones come on top";
    ExtractOptions with_ends;
    with_ends.edge_ends = true;
    expect_equal_levels(packed, 0, {});
    expect_equal_levels(packed, 0, with_ends);
    expect_equal_levels(packed, 0.99, {});
}

TEST(InstructionLevels, StoreTheSameFields) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        const NastyGrid g =
            nasty_grid(seed, {.side = 9, .values = seed % 2 ? 0 : 5, .no_data = seed > 2 ? 0.05 : 0, .missing = 0.05});
        for (const Precision precision : {Precision::single, Precision::double_}) {
            std::string expected;
            for (int level = 0; level <= int(core::best_level()); ++level) {
                core::force_level(core::Level(level));
                const PackedGrid packed = pack(g.grid, g.field, {.precision = precision}).value();
                core::force_level({});
                if (expected.empty()) expected = bytes_of(packed);
                ASSERT_TRUE(bytes_of(packed) == expected)
                    << "seed " << seed << ", " << core::name_of(core::Level(level));
            }
        }
    }
}

} // namespace
} // namespace isotet::test
