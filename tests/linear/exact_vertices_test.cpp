// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// ContourOptions::exact_vertices, RefineOptions::distance, and cells that fold.
#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/check.hpp>
#include <isotet/contour.hpp>

#include "linear/curved_grid.hpp"

namespace isotet::test {
namespace {

double square_of_radius(At p) { return p[0] * p[0] + p[1] * p[1] + p[2] * p[2]; }

At vertex_of(const Surface& surface, std::size_t v) {
    return {surface.positions.at(v, 0), surface.positions.at(v, 1), surface.positions.at(v, 2)};
}

/// How far the vertices are from a field's isovalue, at most.
double largest_error(const Surface& surface, const std::function<double(At)>& field, double isovalue) {
    double largest = 0;
    for (std::size_t v = 0; v < surface.vertex_count(); ++v)
        largest = std::max(largest, std::abs(field(vertex_of(surface, v)) - isovalue));
    return largest;
}

Result<ContourResult> contoured(const ContourInput& input, const ContourOptions& options, double isovalue) {
    auto session = Contour::create(input, options);
    if (!session) return session.error();
    return session->extract(isovalue);
}

ContourOptions exact_options(bool refine, Method method) {
    ContourOptions options;
    options.method = method;
    options.precision = Precision::float64;
    options.exact_vertices = true;
    if (refine) options.refine.emplace().tolerance = 0.05;
    return options;
}

TEST(ExactVertices, LieOnTheQuadraticFieldOfEveryKindOfCell) {
    for (const char* shape : {"kuhn", "hex", "wedge", "pyramid", "mixed"})
        for (const bool refine : {false, true})
            for (const Method method : {Method::direct, Method::clusters}) {
                const CurvedGrid made =
                    curved_grid({.shape = shape, .side = 3, .seed = 5, .shuffle = true, .field = square_of_radius});
                ContourOptions options = exact_options(refine, method);
                const Surface exact =
                    contoured({made.grid, made.field, {}, {}}, options, 0.6).value().surfaces[0].surface;
                options.exact_vertices = false;
                const Surface linear =
                    contoured({made.grid, made.field, {}, {}}, options, 0.6).value().surfaces[0].surface;
                ASSERT_GT(exact.vertex_count(), 50u);
                EXPECT_LT(largest_error(exact, square_of_radius, 0.6), 1e-12) << shape << refine;
                EXPECT_GT(largest_error(linear, square_of_radius, 0.6), 1e-4) << shape << refine;
                EXPECT_EQ(exact.triangle_count(), linear.triangle_count());
                EXPECT_EQ(check(exact).value().boundary_edges, 0u);
                EXPECT_TRUE(exact.edge_ends.empty() && exact.source_cells.empty()) << "not asked for";
            }
}

TEST(ExactVertices, FollowCurvedEdgesAndCarryFieldsAlong) {
    const CurvedGrid made =
        curved_grid({.shape = "mixed", .side = 3, .seed = 2, .shuffle = true, .warp = bulge, .field = wave});
    std::vector<double> x(made.grid.points.tuples());
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = made.grid.points.at(i, 0);
    ContourOptions options = exact_options(false, Method::direct);
    options.edge_ends = true;
    options.normals = Normals::face;
    const ContourInput input{made.grid, made.field, {{"x", Array::own(x)}, {made.field.name, made.field.values}}, {}};
    const Surface surface = contoured(input, options, 0.1).value().surfaces[0].surface;
    ASSERT_GT(surface.vertex_count(), 50u);
    EXPECT_FALSE(surface.edge_ends.empty());
    EXPECT_EQ(surface.normals.tuples(), surface.triangle_count());
    for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
        ASSERT_NEAR(surface.point_fields[0].values.at(v), surface.positions.at(v, 0), 1e-12)
            << "x is curved as the edges are";
        ASSERT_NEAR(surface.point_fields[1].values.at(v), 0.1, 1e-12) << "the field has the isovalue";
    }
    EXPECT_EQ(check(surface).value().inconsistent_edges, 0u);
}

TEST(ExactVertices, LeaveGridsWithoutCurvedCellsAsTheyAre) {
    const Grid grid = make_grid({"mixed", 6, {"sphere"}, 1}).value();
    const ContourInput input{grid, find_field(grid, "sphere").value(), {}, {}};
    for (const Normals normals : {Normals::none, Normals::face, Normals::vertex, Normals::gradient}) {
        ContourOptions options;
        options.normals = normals;
        const Surface plain = contoured(input, options, 0.5).value().surfaces[0].surface;
        options.exact_vertices = true;
        const Surface exact = contoured(input, options, 0.5).value().surfaces[0].surface;
        ASSERT_EQ(exact.positions.size(), plain.positions.size());
        for (std::size_t i = 0; i < plain.vertex_count(); ++i) ASSERT_EQ(vertex_of(exact, i), vertex_of(plain, i));
        ASSERT_EQ(exact.normals.size(), plain.normals.size());
        for (std::size_t i = 0; i < plain.normals.tuples(); ++i)
            for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(exact.normals.at(i, k), plain.normals.at(i, k));
    }
}

TEST(ExactVertices, AreTheSameForAnyNumberOfThreads) {
    const CurvedGrid made =
        curved_grid({.shape = "mixed", .side = 4, .seed = 3, .shuffle = true, .warp = bulge, .field = wave});
    std::vector<At> first;
    for (const int threads : {1, 2, 5}) {
        auto session = Contour::create({made.grid, made.field, {}, {}}, exact_options(true, Method::direct)).value();
        const Surface surface = session.extract(0.1, {.threads = threads, .progress = {}}).value().surfaces[0].surface;
        std::vector<At> vertices(surface.vertex_count());
        for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v] = vertex_of(surface, v);
        if (first.empty()) first = vertices;
        ASSERT_EQ(vertices, first);
    }
}

TEST(RefineToADistance, KeepsTheSurfaceThatNear) {
    const CurvedGrid made =
        curved_grid({.shape = "mixed", .side = 3, .seed = 4, .shuffle = true, .field = square_of_radius});
    std::uint64_t before = 0;
    for (const double distance : {0.05, 0.01, 0.002}) {
        ContourOptions options;
        options.precision = Precision::float64;
        options.refine.emplace().relative_tolerance = 0;
        options.refine->distance = distance;
        const ContourResult result = contoured({made.grid, made.field, {}, {}}, options, 0.6).value();
        const Surface& surface = result.surfaces[0].surface;
        EXPECT_EQ(check(surface).value().boundary_edges, 0u);
        EXPECT_GT(result.refinement.tets, before) << "a smaller distance makes more tets";
        before = result.refinement.tets;
        EXPECT_LE(result.refinement.distance, 1.5 * distance) << "an estimate";
        EXPECT_LE(result.refinement.distance, result.refinement.largest_distance);
        for (std::size_t v = 0; v < surface.vertex_count(); ++v)
            ASSERT_NEAR(std::sqrt(square_of_radius(vertex_of(surface, v))), std::sqrt(0.6), distance);
    }
}

TEST(RefineToADistance, HoldsBesideATolerance) {
    const CurvedGrid made = curved_grid({.shape = "kuhn", .side = 3, .seed = 4, .field = wave});
    RefineOptions options;
    options.tolerance = 0.003;
    options.distance = 100;
    const LinearGrid both = refine(made.grid, made.field, options).value();
    options.distance = 0;
    const LinearGrid tolerance_only = refine(made.grid, made.field, options).value();
    EXPECT_EQ(both.refinement.tets, tolerance_only.refinement.tets);
    options.distance = -1;
    EXPECT_EQ(refine(made.grid, made.field, options).error().message,
              "the distance is -1, but must be finite and not negative");
}

TEST(Refine, EndsWhereACellFolds) {
    // A node in the middle of an edge that lies far outside: the edge bends at every length.
    CurvedGrid made = curved_grid({.shape = "kuhn", .side = 2, .seed = 1, .field = square_of_radius});
    std::vector<double> points(made.grid.points.size());
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = made.grid.points.at(i / 3, i % 3);
    const auto corner = static_cast<std::size_t>(made.grid.cells.connectivity.at(4));
    points[3 * corner] += 1e9;
    made.grid.points = Array::own(std::move(points), 3);
    RefineOptions options;
    options.isovalues = {0.6};
    options.tolerance = 0.1;
    options.max_tets = 5'000'000;
    const LinearGrid folded = refine(made.grid, made.field, options).value();
    EXPECT_TRUE(folded.refinement.too_bent);
    EXPECT_GT(folded.refinement.geometry_bound, 1) << "told, not kept";
    EXPECT_GT(folded.refinement.tets, 0u);
}

} // namespace
} // namespace isotet::test
