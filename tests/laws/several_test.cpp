// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Several isovalues in one pass: each surface is what its isovalue gives alone.
#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/engines.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

std::string text_of(const ExtractReport& report) {
    return std::to_string(report.selected_clusters) + " selected, " + std::to_string(report.tied_points) + " tied, " +
           (report.false_ties ? std::to_string(*report.false_ties) : "?") + " false, near " +
           std::to_string(report.near_tie) + ", stored " + std::to_string(report.isovalue_stored) + ", " +
           std::to_string(report.surface_bytes) + " bytes";
}

void expect_as_alone(Engine engine, const PackedGrid& packed, const std::vector<double>& isovalues,
                     const ExtractOptions& options) {
    const std::vector<Extraction> together = extract_on(engine, packed, isovalues, options).value();
    ASSERT_EQ(together.size(), isovalues.size());
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        const Extraction alone = extract_on(engine, packed, isovalues[i], options).value();
        ASSERT_TRUE(bytes_of(together[i].surface) == bytes_of(alone.surface)) << "isovalue " << isovalues[i];
        EXPECT_EQ(text_of(together[i].report), text_of(alone.report)) << "isovalue " << isovalues[i];
    }
}

void expect_as_alone(const NastyGrid& g, Precision precision, const std::vector<double>& isovalues) {
    PackOptions pack_options;
    pack_options.precision = precision;
    pack_options.source_cells = pack_options.gradients = true;
    const PackedGrid packed = pack(g.grid, g.field, pack_options).value();
    for (const Engine engine : both_engines)
        for (const Ties ties : {Ties::merge, Ties::keep})
            for (const bool extras : {false, true}) {
                ExtractOptions options;
                options.ties = ties;
                options.normals = extras ? Normals::gradient : Normals::face;
                options.edge_ends = options.source_cells = extras;
                if (extras) options.point_fields = {{"value", g.field.values}};
                expect_as_alone(engine, packed, isovalues, options);
            }
}

TEST(SeveralIsovalues, GiveTheSurfacesThatEachGivesAlone) {
    for (const std::uint32_t seed : Seeds(1, 3))
        expect_as_alone(nasty_grid(seed, {.side = 9, .values = 0}), Precision::float32,
                        {0.4, -0.3, 0.1, 0.1001, 5, 0, 0.1, -5});
}

TEST(SeveralIsovalues, GiveTheSurfacesThatEachGivesAloneWithTiesAndNaN) {
    for (const std::uint32_t seed : Seeds(1, 4))
        expect_as_alone(
            nasty_grid(seed,
                       {.side = 7, .values = 4, .no_data = 0.04, .missing = 0.1, .inverted = 0.1, .repeated = 0.05}),
            seed % 2 ? Precision::float32 : Precision::float64, {2, 0, 1, 0.5, 1, -1, 0, 1e300});
}

TEST(SeveralIsovalues, MayBeManyMoreThanClustersHold) {
    const Grid grid = made_grid("shuffled", 6, {"gyroid"});
    std::vector<double> isovalues;
    for (int i = 0; i < 300; ++i) isovalues.push_back(-1.5 + 0.01 * ((i * 7) % 300));
    expect_as_alone(Engine::cpu, pack(grid, point_field(grid)).value(), isovalues, {});
}

TEST(SeveralIsovalues, MayBeNone) {
    const Grid grid = made_grid("kuhn", 3, {"sphere"});
    const std::vector<double> none;
    EXPECT_TRUE(extract(pack(grid, point_field(grid)).value(), none).value().empty());
    EXPECT_EQ(extract(PackedGrid(), std::vector<double>{1, 2}).value().size(), 2u);
}

TEST(SeveralIsovalues, AreRefusedTogetherWhenOneIsNotFinite) {
    const Grid grid = made_grid("kuhn", 3, {"sphere"});
    const auto refused =
        extract(pack(grid, point_field(grid)).value(), std::vector<double>{1, std::numeric_limits<double>::infinity()});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(refused.error().message, "isovalues[1] is inf, but must be finite");
}

} // namespace
} // namespace isotet::test
