// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Every edge of a surface is used equally often in both directions, except in boundary faces of the valid tets: in both
// modes, with ties, NaN, inverted and repeated tets. Told by check(), and by a small oracle of its own.
#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/brute_weld.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

/// Points of the faces that valid tets do not use equally often in their two directions.
std::set<std::set<std::int64_t>> boundary_faces(const Grid& grid, const Array& field) {
    std::map<std::array<std::uint64_t, 3>, int> balance;
    for (const UprightTet& tet : upright_tets(grid)) {
        const auto& t = tet.corners;
        if (std::ranges::any_of(t, [&](std::uint64_t p) { return std::isnan(field.at(p)); })) continue;
        for (const auto& face :
             {std::array{t[1], t[2], t[3]}, {t[0], t[3], t[2]}, {t[0], t[1], t[3]}, {t[0], t[2], t[1]}}) {
            auto sorted = face;
            std::sort(sorted.begin(), sorted.end());
            const auto first = std::ranges::find(face, sorted[0]) - face.begin();
            const bool forward = face[static_cast<std::size_t>(first + 1) % 3] == sorted[1];
            balance[sorted] += forward ? 1 : -1;
        }
    }
    std::set<std::set<std::int64_t>> out;
    for (const auto& [face, sum] : balance)
        if (sum != 0) out.insert(std::set<std::int64_t>(face.begin(), face.end()));
    return out;
}

std::size_t edges_open_inside(const Surface& surface, const Grid& grid, const Array& field) {
    const auto boundary = boundary_faces(grid, field);
    std::map<DirectedEdge, std::int64_t> balance; // lower end first
    for (std::size_t t = 0; t < surface.triangle_count(); ++t) {
        const auto c = corners_of(surface, t);
        for (std::size_t k = 0; k < 3; ++k) {
            const Ends a = ends_of(surface, c[k]), b = ends_of(surface, c[(k + 1) % 3]);
            if (a < b) ++balance[{a, b}];
            else --balance[{b, a}];
        }
    }
    std::size_t open = 0;
    for (const auto& [edge, sum] : balance) {
        if (sum == 0) continue;
        const std::set<std::int64_t> points{edge.first.first, edge.first.second, edge.second.first, edge.second.second};
        open += std::ranges::none_of(boundary, [&](const auto& face) { return std::ranges::includes(face, points); });
    }
    return open;
}

void expect_closed(const NastyGrid& g, const std::vector<double>& isovalues, const std::string& which) {
    const PackedGrid packed = pack(g.grid, g.field).value();
    for (const double isovalue : isovalues)
        for (const Ties ties : {Ties::merge, Ties::keep}) {
            SCOPED_TRACE(testing::Message() << which << ", isovalue " << isovalue << ", ties " << int(ties));
            ExtractOptions options;
            options.ties = ties;
            options.edge_ends = true;
            const Surface surface = extract(packed, isovalue, options).value().surface;
            CheckOptions check_options;
            check_options.grid = &g.grid;
            check_options.field = &g.field;
            const SurfaceReport report = check(surface, check_options).value();
            ASSERT_EQ(report.blamed_edges, 0u) << (report.findings.empty() ? "" : report.findings[0].what);
            ASSERT_EQ(report.blamed_duplicates, 0u);
            ASSERT_EQ(report.equal_corner_triangles, 0u);
            ASSERT_EQ(report.unused_vertices, 0u);
            ASSERT_EQ(edges_open_inside(surface, g.grid, g.field.values), 0u);
        }
}

void expect_closed(std::uint32_t seed, const NastyOptions& nasty, const std::vector<double>& isovalues) {
    expect_closed(nasty_grid(seed, nasty), isovalues, "seed " + std::to_string(seed));
}

TEST(Surfaces, AreClosedOffTheBoundaryWithTies) {
    for (const std::uint32_t seed : Seeds(1000, 16))
        expect_closed(seed, {.side = 2 + int(seed) % 6, .values = 2 + int(seed) % 3}, {0, 0.5, 1});
}

TEST(Surfaces, AreClosedOffTheBoundaryOfPointsWithData) {
    for (const std::uint32_t seed : Seeds(1100, 16))
        expect_closed(seed, {.side = 2 + int(seed) % 6, .values = 3, .no_data = 0.04 * (1 + seed % 5)}, {0, 1});
}

TEST(Surfaces, AreClosedOffTheBoundaryOfTangledGridsWithRepeatedTets) {
    for (const std::uint32_t seed : Seeds(1200, 16))
        expect_closed(seed,
                      {.side = 2 + int(seed) % 6,
                       .values = 3,
                       .no_data = 0.03,
                       .missing = 0.15,
                       .inverted = 0.3,
                       .mirrored = 0.5,
                       .repeated = 0.3},
                      {0, 0.5, 1});
}

TEST(Surfaces, AreClosedOffTheBoundaryOfFlatAndSliverGrids) {
    for (const double height : {0.0, 1e-30, 1e-6}) {
        NastyGrid g = nasty_grid(1300, {.side = 5, .values = 3, .no_data = 0.02, .mirrored = 0.5, .repeated = 0.1});
        std::vector<float> squashed(g.grid.points.as<float>().begin(), g.grid.points.as<float>().end());
        for (std::size_t i = 2; i < squashed.size(); i += 3) squashed[i] = static_cast<float>(squashed[i] * height);
        g.grid.points = Array::own(std::move(squashed), 3);
        expect_closed(g, {0, 0.5, 1}, "height " + std::to_string(height));
    }
}

TEST(Surfaces, HaveNoFlatTriangleAndNoCoincidentVertexFromTies) {
    for (const char* shape : {"kuhn", "perturbed", "shuffled", "hex", "wedge", "pyramid", "mixed"}) {
        const Grid grid = made_grid(shape, 8, {"integer"}, 3);
        const PackedGrid packed = pack(grid, point_field(grid)).value();
        for (const double isovalue : {0.5, 1.0, 2.0, 3.0, 4.0}) {
            const SurfaceReport report = check(extract(packed, isovalue).value().surface).value();
            EXPECT_GT(report.triangles, 0u);
            EXPECT_EQ(report.zero_area_triangles, 0u) << shape << ", isovalue " << isovalue;
            EXPECT_EQ(report.coincident_vertices, 0u) << shape << ", isovalue " << isovalue;
            EXPECT_EQ(report.duplicate_triangles, 0u) << shape << ", isovalue " << isovalue;
        }
    }
}

TEST(Surfaces, HaveFlatTrianglesFromTiesInKeptModeAlone) {
    const Grid grid = made_grid("kuhn", 6, {"integer"});
    const PackedGrid packed = pack(grid, point_field(grid)).value();
    ExtractOptions keep;
    keep.ties = Ties::keep;
    EXPECT_GT(check(extract(packed, 2, keep).value().surface).value().zero_area_triangles, 0u);
}

TEST(Surfaces, AreManifoldsInKeptModeWhereTheTetsAroundEveryEdgeAreOneFan) {
    for (const char* shape : {"kuhn", "shuffled", "hex", "wedge", "pyramid", "mixed", "layer"}) {
        const Grid grid = made_grid(shape, 7, {"integer"}, 11);
        const PackedGrid packed = pack(grid, point_field(grid)).value();
        ExtractOptions keep;
        keep.ties = Ties::keep;
        for (const double isovalue : {0.5, 1.0, 2.0, 4.0}) {
            const SurfaceReport report = check(extract(packed, isovalue, keep).value().surface).value();
            EXPECT_GT(report.triangles, 0u);
            EXPECT_EQ(report.non_manifold_edges, 0u) << shape << ", isovalue " << isovalue;
            EXPECT_EQ(report.inconsistent_edges, 0u) << shape << ", isovalue " << isovalue;
            EXPECT_EQ(report.touching_vertices, 0u) << shape << ", isovalue " << isovalue;
        }
    }
}

/// A field that is below near the boundary of the cube, so that its surface does not reach it.
TEST(Surfaces, OfAClosedFieldAreClosedEverywhere) {
    for (const char* shape : {"kuhn", "shuffled", "layer", "mixed"}) {
        const Grid grid = made_grid(shape, 9, {"integer"}, 5);
        std::vector<std::int32_t> values;
        const auto random = grid.point_fields[0].values.as<std::int32_t>();
        for (std::size_t p = 0; p < random.size(); ++p) {
            const bool at_boundary =
                std::ranges::any_of(point_of(grid.points, p), [](double x) { return std::abs(x) == 1; });
            values.push_back(at_boundary ? -1 : random[p]);
        }
        const PackedGrid packed = pack(grid, field_of(std::move(values))).value();
        for (const double isovalue : {0.0, 1.0, 2.5})
            for (const Ties ties : {Ties::merge, Ties::keep}) {
                ExtractOptions options;
                options.ties = ties;
                const SurfaceReport report = check(extract(packed, isovalue, options).value().surface).value();
                EXPECT_GT(report.triangles, 100u);
                EXPECT_TRUE(report.closed) << shape << ", isovalue " << isovalue;
            }
    }
}

} // namespace
} // namespace isotet::test
