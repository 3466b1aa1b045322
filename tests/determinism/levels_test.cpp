// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The same bytes from portable code, AVX2 and AVX-512: as far as the machine goes, which the test prints.
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>

#include "determinism/packed_bytes.hpp"
#include "numbers/level.hpp"
#include "support/engines.hpp"
#include "support/random_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

/// The reference's surface, from every level.
void expect_equal_levels(const PackedGrid& packed, double isovalue, const ExtractOptions& options) {
    const std::string expected = bytes_of(extract_on(Engine::reference, packed, isovalue, options).value().surface);
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
        for (const double isovalue : {-0.5, 0.0, 0.1, 0.25, 1.5})
            for (const bool extras : {false, true}) {
                ExtractOptions options;
                options.edge_ends = options.source_cells = extras;
                options.normals = extras ? Normals::gradient : Normals::none;
                SCOPED_TRACE(fmt::format("seed {}", seed));
                expect_equal_levels(packed, isovalue, options);
            }
    }
}

/// With and without what records keep for it.
void expect_equal_levels_of_all(const PackedGrid& packed, double isovalue) {
    for (const Ties ties : {Ties::merge, Ties::keep})
        for (const bool extras : {false, true}) {
            ExtractOptions options;
            options.ties = ties;
            options.edge_ends = options.source_cells = extras;
            expect_equal_levels(packed, isovalue, options);
        }
}

/// Noise cuts half of all edges, and clusters have more vertices than a byte can number: one alone, and among others.
TEST(InstructionLevels, GiveTheSameBytesOfNoise) {
    for (const std::uint64_t side : {4, 12}) {
        const Grid grid = make_grid({.shape = "kuhn", .side = side}).value();
        std::mt19937 random(1);
        std::vector<float> noise(grid.points.tuples());
        for (float& value : noise) value = std::uniform_real_distribution<float>(-1, 1)(random);
        PointField field;
        field.values = Array::own(std::move(noise));
        const PackedGrid packed = pack(grid, field, {.source_cells = true}).value();
        if (side == 4) {
            ASSERT_EQ(packed.report().clusters, 1u);
            ASSERT_GT(extract(packed, 0).value().surface.positions.tuples(), 256u);
        }
        expect_equal_levels_of_all(packed, 0);
        expect_equal_levels_of_all(packed, 0.99);
    }
}

/// A fan round one edge: from each of its ends edges go to nearly all points of the cluster.
TEST(InstructionLevels, GiveTheSameBytesOfAFan) {
    constexpr std::uint32_t rim = 126;
    Grid grid;
    std::vector<float> points{0, 0, -1, 0, 0, 1};
    std::vector<std::uint32_t> tets;
    for (std::uint32_t k = 0; k < rim; ++k) {
        const double angle = 2 * std::numbers::pi * k / rim;
        points.insert(points.end(), {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0});
        tets.insert(tets.end(), {0, 1, 2 + k, 2 + (k + 1) % rim});
    }
    grid.points = Array::own(std::move(points), 3);
    grid.cells.connectivity = Array::own(std::move(tets));
    for (const bool both : {false, true}) { // ends of the edge below
        std::vector<float> values(2 + rim, 1);
        values[0] = -1;
        if (both) values[1] = -2;
        PointField field;
        field.values = Array::own(std::move(values));
        const PackedGrid packed = pack(grid, field, {.source_cells = true}).value();
        ASSERT_EQ(packed.report().clusters, 1u);
        expect_equal_levels_of_all(packed, 0);
    }
}

TEST(InstructionLevels, StoreTheSameFields) {
    for (std::uint32_t seed = 1; seed <= 4; ++seed) {
        const NastyGrid g =
            nasty_grid(seed, {.side = 9, .values = seed % 2 ? 0 : 5, .no_data = seed > 2 ? 0.05 : 0, .missing = 0.05});
        for (const Precision precision : {Precision::float32, Precision::float64}) {
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
