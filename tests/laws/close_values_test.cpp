// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A float32 field is contoured at the isovalue as given, however close its values are: a single packing gives the
// surface of a double one.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/close_values.hpp"
#include "support/engines.hpp"
#include "support/seeds.hpp"
#include "support/surface_sets.hpp"

namespace isotet::test {
namespace {

/// By the ends of the vertices, all of which must be different.
std::map<Ends, double> weights_of(const Surface& surface) {
    std::map<Ends, double> weights;
    for (std::size_t v = 0; v < surface.vertex_count(); ++v)
        EXPECT_TRUE(weights.emplace(ends_of(surface, v), surface.edge_weights.at(v)).second);
    return weights;
}

void expect_same_surface(const Extraction& single, const Extraction& expected) {
    EXPECT_EQ(single.report.tied_points, expected.report.tied_points);
    EXPECT_EQ(single.report.false_ties, 0u);
    EXPECT_EQ(single.surface.triangle_count(), expected.surface.triangle_count());
    const auto weights = weights_of(single.surface), exact = weights_of(expected.surface);
    ASSERT_EQ(weights.size(), exact.size());
    for (const auto& [ends, weight] : exact) {
        ASSERT_TRUE(weights.contains(ends)) << "a point changed sides";
        ASSERT_NEAR(weights.at(ends), weight, 0x1p-22);
    }
    EXPECT_NEAR(area(single.surface), area(expected.surface), 1e-5 * area(expected.surface) + 1e-6);
}

/// From clusters by both engines, and from plain arrays.
void expect_the_surface_of_a_double_packing(const Grid& grid, const PointField& field, double isovalue) {
    SCOPED_TRACE(testing::Message() << "isovalue " << std::hexfloat << isovalue);
    const PackedGrid single = pack(grid, field).value(), exact = pack(grid, field, {Precision::float64}).value();
    for (const Ties ties : {Ties::merge, Ties::keep}) {
        ExtractOptions options;
        options.ties = ties;
        options.edge_ends = true;
        const Extraction expected = extract(exact, isovalue, options).value();
        expect_same_surface(extract(single, isovalue, options).value(), expected);
        const DirectExtraction once = extract_direct(grid, field, {&isovalue, 1}, {options}).value();
        expect_same_surface(once.surfaces.at(0), expected);
        expect_same_surface(extract_on(Engine::reference, single, isovalue, options).value(), expected);
    }
}

void expect_exact(const CloseValues& close, std::uint32_t seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed << ", base " << close.base << ", steps " << close.steps);
    const Grid grid = made_grid("perturbed", 9, {"gyroid"}, seed);
    const PointField field = close.field(grid);
    std::mt19937 random(seed);
    for (const double share : {1e-9, 0.3, 0.5, 0.96, 1 - 1e-9, 0.0}) {
        const int step = static_cast<int>(random() % static_cast<unsigned>(close.steps));
        expect_the_surface_of_a_double_packing(grid, field, close.isovalue(step, share));
    }
}

CloseValues random_values(std::uint32_t seed) {
    std::mt19937 random(seed);
    CloseValues close;
    close.base = std::exp2(std::uniform_real_distribution<float>(-40, 40)(random));
    close.steps = 1 + static_cast<int>(random() % 12);
    return close;
}

TEST(CloseValues, AreContouredAtTheIsovalueAsGiven) {
    for (const std::uint32_t seed : Seeds(1, 6)) expect_exact(random_values(seed), seed);
}

TEST(CloseValues, AreContouredAtTheIsovalueAsGivenBesideValuesFarOff) {
    for (const std::uint32_t seed : Seeds(1, 6)) {
        CloseValues close = random_values(seed);
        close.far_values = true;
        expect_exact(close, seed);
    }
}

TEST(CloseValues, OfWhichAnIsovalueIsOneAreTied) {
    const CloseValues close;
    const Grid grid = made_grid("perturbed", 9, {"gyroid"});
    const PointField field = close.field(grid);
    const auto values = field.values.as<float>();
    const auto ties = static_cast<std::uint64_t>(std::count(values.begin(), values.end(), close.at(3)));
    ASSERT_GT(ties, 100u);
    const ExtractReport report = extract(pack(grid, field).value(), close.isovalue(3, 0)).value().report;
    EXPECT_EQ(report.tied_points, ties);
    EXPECT_EQ(report.false_ties, 0u);
}

} // namespace
} // namespace isotet::test
