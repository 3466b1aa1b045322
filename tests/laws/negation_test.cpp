// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Without ties, negating field and isovalue turns every triangle round and changes nothing else, diagonals included.
#include <set>

#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/surface_sets.hpp"

namespace isotet::test {
namespace {

/// A triangle by the grid edges of its corners without their direction, turned so that the lowest comes first.
using Triangle = std::array<Ends, 3>;

Ends without_direction(const Ends& ends) { return std::minmax(ends.first, ends.second); }

std::multiset<Triangle> triangles_of(const Surface& surface, bool turned_round) {
    std::multiset<Triangle> out;
    for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
        Triangle triangle;
        const auto corners = corners_of(surface, t);
        for (std::size_t k = 0; k < 3; ++k)
            triangle[k] = without_direction(ends_of(surface, corners[turned_round ? 2 - k : k]));
        std::rotate(triangle.begin(), std::ranges::min_element(triangle), triangle.end());
        out.insert(triangle);
    }
    return out;
}

PointField negated(const PointField& field) {
    std::vector<float> values;
    for (const float v : field.values.as<float>()) values.push_back(-v);
    return {field.name, Array::own(std::move(values)), false, {}};
}

TEST(Negation, TurnsEveryTriangleRound) {
    for (const std::uint32_t seed : Seeds(1, 8)) {
        const NastyGrid g =
            nasty_grid(seed, {.side = 8, .values = int(seed % 2) * 5, .no_data = 0.02, .inverted = 0.1});
        const double isovalue = seed % 2 ? 0.25 : 0.125;
        ExtractOptions options;
        options.edge_ends = true;
        const Extraction positive = extract(pack(g.grid, g.field).value(), isovalue, options).value();
        const Extraction negative = extract(pack(g.grid, negated(g.field)).value(), -isovalue, options).value();
        ASSERT_EQ(positive.report.tied_points, 0u);
        ASSERT_GT(positive.surface.triangle_count(), 0u);
        ASSERT_EQ(triangles_of(positive.surface, true), triangles_of(negative.surface, false)) << "seed " << seed;

        std::map<Ends, std::array<double, 3>> places;
        for (std::size_t v = 0; v < negative.surface.vertex_count(); ++v)
            places[ends_of(negative.surface, v)] = position_of(negative.surface, v);
        for (std::size_t v = 0; v < positive.surface.vertex_count(); ++v) {
            const Ends ends = ends_of(positive.surface, v);
            const auto here = position_of(positive.surface, v), there = places.at({ends.second, ends.first});
            for (std::size_t axis = 0; axis < 3; ++axis) ASSERT_NEAR(here[axis], there[axis], 1e-6);
        }
    }
}

} // namespace
} // namespace isotet::test
