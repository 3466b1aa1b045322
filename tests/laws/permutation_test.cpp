// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The numbering of points and cells does not matter: the same vertices bit for bit, and of a grid of tetrahedra the
// same triangles up to the diagonals of quadrilaterals.
#include <numeric>
#include <random>

#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/surface_sets.hpp"

namespace isotet::test {
namespace {

/// new number -> old number
std::vector<std::size_t> shuffled_numbers(std::size_t count, std::mt19937& random) {
    std::vector<std::size_t> old(count);
    std::iota(old.begin(), old.end(), std::size_t{0});
    std::shuffle(old.begin(), old.end(), random);
    return old;
}

struct Permuted {
    Grid grid;
    PointField field;
    std::vector<std::size_t> old_point, old_tet;
};

template <class Real>
Permuted permuted(const Grid& grid, const PointField& field, std::uint32_t seed, bool points_too) {
    std::mt19937 random(seed);
    const std::size_t points = grid.points.tuples(), tets = grid.cells.count();
    Permuted out;
    out.old_tet = shuffled_numbers(tets, random);
    out.old_point = shuffled_numbers(points, random);
    if (!points_too) std::iota(out.old_point.begin(), out.old_point.end(), std::size_t{0});
    std::vector<std::int64_t> new_point(points);
    std::vector<Real> coordinates;
    std::vector<float> values;
    for (std::size_t p = 0; p < points; ++p) {
        new_point[out.old_point[p]] = static_cast<std::int64_t>(p);
        for (std::size_t axis = 0; axis < 3; ++axis)
            coordinates.push_back(static_cast<Real>(grid.points.at(out.old_point[p], axis)));
        values.push_back(static_cast<float>(field.values.at(out.old_point[p])));
    }
    std::vector<std::int64_t> corners;
    for (const std::size_t tet : out.old_tet) {
        std::array<std::size_t, 4> order{0, 1, 2, 3};
        std::shuffle(order.begin(), order.end(), random);
        for (const std::size_t k : order)
            corners.push_back(new_point[static_cast<std::size_t>(grid.cells.connectivity.at(4 * tet + k))]);
    }
    out.grid.points = Array::own(std::move(coordinates), 3);
    out.grid.cells.connectivity = Array::own(std::move(corners));
    out.field = {"value", Array::own(std::move(values)), false, {}};
    return out;
}

SurfaceSets extracted_sets(const Grid& grid, const PointField& field, double isovalue, Ties ties) {
    PackOptions pack_options;
    pack_options.source_cells = true;
    ExtractOptions options;
    options.ties = ties;
    options.edge_ends = options.source_cells = true;
    return sets_of(extract(pack(grid, field, pack_options).value(), isovalue, options).value().surface);
}

/// The sets of a permuted grid in the old numbers.
SurfaceSets in_old_numbers(const SurfaceSets& sets, const Permuted& permuted) {
    const auto old = [&](const Ends& ends) {
        return Ends{static_cast<std::int64_t>(permuted.old_point[static_cast<std::size_t>(ends.first)]),
                    static_cast<std::int64_t>(permuted.old_point[static_cast<std::size_t>(ends.second)])};
    };
    SurfaceSets out;
    for (const auto& [ends, position] : sets.vertices) out.vertices[old(ends)] = position;
    for (const auto& [cell, triangles] : sets.cells) {
        CellTriangles& mapped = out.cells[static_cast<std::int64_t>(permuted.old_tet[static_cast<std::size_t>(cell)])];
        mapped.count = triangles.count;
        for (const auto& [from, to] : triangles.outline) mapped.add_edge(old(from), old(to));
    }
    return out;
}

void expect_same(std::uint32_t seed, const NastyOptions& nasty, bool points_too, const std::vector<double>& isovalues) {
    const NastyGrid g = nasty_grid(seed, nasty);
    const Permuted other = nasty.wide ? permuted<double>(g.grid, g.field, seed, points_too)
                                      : permuted<float>(g.grid, g.field, seed, points_too);
    for (const double isovalue : isovalues)
        for (const Ties ties : {Ties::merge, Ties::keep}) {
            const SurfaceSets before = extracted_sets(g.grid, g.field, isovalue, ties);
            const SurfaceSets after = extracted_sets(other.grid, other.field, isovalue, ties);
            ASSERT_FALSE(before.vertices.empty());
            ASSERT_EQ(before.positions(), after.positions()) << "seed " << seed << ", isovalue " << isovalue;
            ASSERT_EQ(before, in_old_numbers(after, other)) << "seed " << seed << ", isovalue " << isovalue;
        }
}

TEST(Permutation, OfTetsChangesNoGeometry) {
    for (const std::uint32_t seed : Seeds(1, 6))
        expect_same(seed, {.side = 7, .values = int(seed % 2) * 4, .no_data = 0.02}, false, {0, 0.5});
}

TEST(Permutation, OfPointsAndTetsChangesNoGeometry) {
    for (const std::uint32_t seed : Seeds(11, 6))
        expect_same(seed, {.side = 7, .values = int(seed % 2) * 4, .no_data = 0.02}, true, {0, 0.5});
}

TEST(Permutation, OfTangledGridsChangesNoGeometry) {
    for (const std::uint32_t seed : Seeds(21, 6))
        expect_same(seed, {.side = 6, .values = 3, .missing = 0.2, .inverted = 0.3, .mirrored = 0.4}, true, {0, 0.5});
}

TEST(Permutation, OfGridsInFloat64ChangesNoGeometry) {
    for (const std::uint32_t seed : Seeds(31, 4))
        expect_same(seed, {.side = 6, .values = 3, .missing = 0.1, .wide = true}, true, {0, 0.5});
}

} // namespace
} // namespace isotet::test
