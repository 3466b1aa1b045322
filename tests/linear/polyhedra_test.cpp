// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polyhedra as linear cells: no holes, linear fields exact, known shapes known, broken ones told.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>

#include "linear/polyhedral_grid.hpp"
#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"
#include "support/surface_sets.hpp"

namespace isotet::test {
namespace {

PointField random_values(const Grid& grid, unsigned seed, unsigned values) {
    std::mt19937 random(seed);
    std::vector<float> out(grid.points.tuples());
    for (float& value : out) value = static_cast<float>(random() % values);
    return {"value", Array::own(std::move(out)), false, {}};
}

PointField height_of(const Grid& grid) {
    std::vector<double> out(grid.points.tuples());
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = grid.points.at(i, 0) + 2 * grid.points.at(i, 1) - 0.5 * grid.points.at(i, 2);
    return {"height", Array::own(std::move(out)), false, {}};
}

ContourResult contoured(const Grid& grid, const PointField& field, double isovalue, ContourOptions options = {}) {
    options.edge_ends = options.source_cells = true;
    return Contour::create({grid, field, {}, {}}, options).value().extract(isovalue).value();
}

double volume_of(const LinearGrid& linear) {
    double volume = 0;
    for (const auto& t : split(linear.grid).value().tets) {
        double e[3][3];
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis)
                e[k][axis] = linear.grid.points.at(t[k + 1], axis) - linear.grid.points.at(t[0], axis);
        volume +=
            (e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
             e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
            6;
    }
    return std::abs(volume);
}

/// A prism over a polygon in the plane z = 0, up to z = 1.
Grid prism(const std::vector<std::array<double, 2>>& polygon) {
    const auto n = static_cast<std::int64_t>(polygon.size());
    std::vector<double> points;
    for (const double z : {0.0, 1.0})
        for (const auto& [x, y] : polygon) points.insert(points.end(), {x, y, z});
    CellFaces faces(2);
    for (std::int64_t i = 0; i < n; ++i) {
        faces[0].push_back(i);
        faces[1].push_back(n + i);
        faces.push_back({i, (i + 1) % n, n + (i + 1) % n, n + i});
    }
    PolyhedronList list;
    list.add(faces);
    Grid grid;
    grid.points = Array::own(std::move(points), 3);
    grid.cells = list.cells();
    return grid;
}

TEST(Polyhedra, ThatAreLinearCellsGiveTheirSurface) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed"}) {
        const Grid grid = made_grid(shape, 5, {"integer", "gyroid"}, 3);
        const Grid faces = as_polyhedra(grid, Listed::as_corners, 7);
        for (const Field& field : grid.point_fields)
            for (const Method method : {Method::clusters, Method::direct}) {
                const PointField values{field.name, field.values, false, {}};
                const auto whole = contoured(grid, values, 0.5, {.method = method});
                const auto same = contoured(faces, values, 0.5, {.method = method});
                EXPECT_GT(whole.surfaces[0].surface.triangle_count(), 0u);
                EXPECT_TRUE(bytes_of(whole.surfaces[0].surface) == bytes_of(same.surfaces[0].surface))
                    << shape << " " << field.name;
            }
        const LinearizeReport report = linearize(faces).value().report;
        EXPECT_EQ(report.known_shapes, grid.cells.count());
        EXPECT_EQ(report.centred, 0u);
    }
}

TEST(Polyhedra, ThatAreLinearCellsAreKnownInAnyOrder) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed", "kuhn"}) {
        const Grid grid = made_grid(shape, 4, {"gyroid"}, 3);
        const PointField values{"gyroid", grid.point_fields[0].values, false, {}};
        const auto expected = sets_of(contoured(grid, values, 0.1).surfaces[0].surface);
        std::string first;
        for (const unsigned seed : {1u, 2u, 3u}) {
            const Grid faces = as_polyhedra(grid, Listed::ascending, seed);
            EXPECT_EQ(linearize(faces).value().report.known_shapes, grid.cells.count()) << shape;
            const Surface surface = contoured(faces, values, 0.1).surfaces[0].surface;
            EXPECT_EQ(sets_of(surface).vertices, expected.vertices) << shape;
            EXPECT_EQ(sets_of(surface).triangle_count(), expected.triangle_count()) << shape;
            if (first.empty()) first = bytes_of(surface);
            EXPECT_TRUE(bytes_of(surface) == first) << "the order of faces must not matter: " << shape;
        }
    }
}

TEST(Polyhedra, WithHangingPointsLeaveNoHole) {
    for (unsigned seed = 1; seed <= 12; ++seed) {
        const Grid grid = octree_grid({.seed = seed});
        const LinearizeReport report = linearize(grid).value().report;
        ASSERT_GT(report.centred, 0u);
        ASSERT_EQ(report.open, 0u);
        ASSERT_EQ(report.folded, 0u) << "seed " << seed;
        for (const bool split_cells : {false, true})
            for (const unsigned values : {2u, 5u}) {
                const PointField field = random_values(grid, seed, values);
                const auto result = contoured(grid, field, 1, {.split_cells = split_cells});
                const SurfaceReport found =
                    check(result.surfaces[0].surface, {.grid = &grid, .field = &field, .split_cells = split_cells})
                        .value();
                ASSERT_TRUE(found.sound) << "seed " << seed << ": "
                                         << (found.findings.empty() ? "" : found.findings[0].what);
            }
    }
}

TEST(Polyhedra, FillTheSpaceOfTheirFaces) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const LinearGrid linear = linearize(octree_grid({.seed = seed, .moved = 0})).value();
        EXPECT_NEAR(volume_of(linear), 6 * 6 * 6, 1e-9);
        EXPECT_EQ(survey(linear.grid).value().inverted_tets, 0u);
    }
}

TEST(Polyhedra, GiveTheSameSurfaceHoweverTheirFacesAreWound) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
        std::string first;
        for (unsigned winding = 1; winding <= 4; ++winding) {
            const Grid grid = octree_grid({.seed = seed, .winding = winding});
            const auto result = contoured(grid, random_values(grid, seed, 4), 1.5);
            const std::string bytes = bytes_of(result.surfaces[0].surface);
            if (first.empty()) first = bytes;
            ASSERT_TRUE(bytes == first) << "seed " << seed << ", winding " << winding;
        }
    }
}

TEST(Polyhedra, GiveTheSameSurfaceInAnyOrderOfCells) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
        const Grid grid = octree_grid({.seed = seed}), backwards = octree_grid({.seed = seed, .reversed = true});
        const PointField field = random_values(grid, seed, 6);
        const auto one = sets_of(contoured(grid, field, 2.5).surfaces[0].surface);
        const auto other = sets_of(contoured(backwards, field, 2.5).surfaces[0].surface);
        EXPECT_EQ(one.positions(), other.positions());
        EXPECT_EQ(one.triangle_count(), other.triangle_count());
    }
}

TEST(Polyhedra, GiveAPlaneOfALinearField) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const Grid grid = octree_grid({.seed = seed, .moved = 0.15});
        const auto result = contoured(grid, height_of(grid), 5.3, {.precision = Precision::float64});
        const Surface& surface = result.surfaces[0].surface;
        ASSERT_GT(surface.vertex_count(), 100u);
        for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
            const auto p = position_of(surface, v);
            ASSERT_NEAR(p[0] + 2 * p[1] - 0.5 * p[2], 5.3, 1e-12);
        }
    }
}

TEST(Polyhedra, GiveTheSameBytesForAnyNumberOfThreads) {
    const Grid grid = as_polyhedra(made_grid("hex", 14, {"gyroid"}, 1), Listed::ascending, 1); // several blocks
    std::string first;
    for (const int threads : {1, 2, 7}) {
        const LinearGrid linear = linearize(grid, {.known_shapes = false}, {.threads = threads}).value();
        std::string bytes;
        for (const Array* array : {&linear.grid.points, &linear.grid.cells.connectivity, &linear.grid.cells.offsets,
                                   &linear.source_cells, &linear.derived.points, &linear.derived.weights})
            append_bytes(bytes, *array);
        if (first.empty()) first = bytes;
        EXPECT_TRUE(bytes == first) << threads << " threads";
    }
}

TEST(Polyhedra, OfConcaveFacesAreFilledByAMovedCentre) {
    const Grid ell = prism({{0, 0}, {3, 0}, {3, 0.5}, {0.5, 0.5}, {0.5, 3}, {0, 3}});
    const LinearGrid linear = linearize(ell).value();
    EXPECT_EQ(linear.report.moved_centres, 1u);
    EXPECT_EQ(linear.report.folded, 0u);
    EXPECT_NEAR(volume_of(linear), 2.75, 1e-12);
    EXPECT_EQ(survey(linear.grid).value().inverted_tets, 0u);
    const Array height = linear.extend(height_of(ell).values).value();
    const std::size_t centre = linear.user_points;
    EXPECT_NEAR(height.at(centre),
                linear.grid.points.at(centre, 0) + 2 * linear.grid.points.at(centre, 1) -
                    0.5 * linear.grid.points.at(centre, 2),
                1e-12)
        << "the weights keep linear fields exact";
}

TEST(Polyhedra, WithoutAPointThatSeesAllFacesAreCounted) {
    const Grid u = prism({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}});
    const LinearGrid linear = linearize(u).value();
    EXPECT_EQ(linear.report.folded, 1u);
    EXPECT_NEAR(volume_of(linear), 7, 1e-9) << "parts that are inside out count negative";
    const auto result = contoured(u, height_of(u), 2);
    ASSERT_EQ(result.notes.size(), 2u);
    EXPECT_NE(result.notes[1].find("no point that sees all their faces"), std::string::npos);
}

TEST(Polyhedra, ThatAreOpenAreLeftOutAndCounted) {
    const Grid whole = as_polyhedra(made_grid("hex", 3, {"gyroid"}, 1), Listed::as_corners, 1);
    PolyhedronList list;
    list.add_linear(10, {0, 1, 4, 16});
    list.add({{0, 1, 2}, {0, 1, 3}, {0, 2, 3}});                       // a face is missing
    list.add({{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}, {1, 2, 3}}); // one is there twice
    list.add({{0, 1, 2, 1}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}});         // one meets itself
    list.add({{0, 0, 0}, {1, 1}, {2}, {3, 3, 3}});                     // none has three points
    list.add(
        {{0, 1, 4}, {0, 1, 16}, {0, 4, 16}, {1, 4, 16}, {2, 3, 6}, {2, 3, 18}, {2, 6, 18}, {3, 6, 18}}); // two shells
    list.add({{0, 0, 1, 4, 4}, {0, 1, 16}, {0, 4, 16, 16}, {1, 4, 16}, {0, 0, 1}}); // repeated points: a tetrahedron
    Grid grid = whole;
    grid.cells = list.cells();
    grid.point_fields.clear();
    const LinearGrid linear = linearize(grid).value();
    EXPECT_EQ(linear.report.polyhedra, 6u);
    EXPECT_EQ(linear.report.open, 5u);
    EXPECT_EQ(linear.report.known_shapes, 1u);
    EXPECT_EQ(survey(grid).value().cells_left_out, 5u);
    EXPECT_EQ(contoured(grid, height_of(grid), -2).cells_left_out, 5u);
}

std::string error_of(const PolyhedronList& list) {
    Grid grid = made_grid("hex", 3, {}, 1);
    grid.cells = list.cells();
    const auto linear = linearize(grid);
    return linear ? "no error" : linear.error().message;
}

TEST(Polyhedra, WithBrokenFacesAreErrors) {
    const auto changed = [](const auto& change) {
        PolyhedronList list;
        list.add({{0, 1, 4}, {0, 1, 16}, {0, 4, 16}, {1, 4, 16}});
        change(list);
        return error_of(list);
    };
    EXPECT_EQ(changed([](PolyhedronList&) {}), "no error");
    EXPECT_EQ(changed([](PolyhedronList& l) { l.faces[2] = 64; }),
              "cells[0] (polyhedron) has a face with point 64, but the grid has 64 points");
    EXPECT_EQ(changed([](PolyhedronList& l) { l.faces[2] = -1; }),
              "cells[0] (polyhedron) has a face with point -1, but the grid has 64 points");
    EXPECT_EQ(changed([](PolyhedronList& l) { l.faces[0] = 5; }),
              "cells[0] (polyhedron) has 5 faces, but its 17 entries end in face 4");
    EXPECT_EQ(changed([](PolyhedronList& l) { l.faces[0] = 3; }),
              "cells[0] (polyhedron) has 3 faces in 17 entries, but 4 are left over");
    EXPECT_EQ(changed([](PolyhedronList& l) { l.faces[1] = -3; }),
              "cells[0] (polyhedron) has 4 faces, but its 17 entries end in face 0");
    EXPECT_EQ(changed([](PolyhedronList& l) { l.face_offsets[1] = 99; }),
              "cells[0] (polyhedron) has faces 0 to 99, but there are 17 entries, and offsets must not fall");
    EXPECT_EQ(changed([](PolyhedronList& l) { l.face_offsets.push_back(17); }),
              "there are 3 offsets of faces for 1 cells, but there must be one more than cells");
    EXPECT_EQ(changed([](PolyhedronList& l) { l.connectivity[0] = 64; }),
              "cells[0] (polyhedron) has point 64, but the grid has 64 points");
}

TEST(Polyhedra, AloneAndOpenAreAnError) {
    PolyhedronList list;
    list.add({{0, 1, 2}, {0, 1, 3}, {0, 2, 3}});
    EXPECT_EQ(error_of(list),
              "the grid with 64 points and 1 cells has no cell that can be contoured: the faces of 1 of "
              "its 1 polyhedra do not close");
}

TEST(Polyhedra, AreRefusedByPackingWithTheNameOfWhatHelps) {
    const Grid grid = as_polyhedra(made_grid("hex", 3, {"gyroid"}, 1), Listed::as_corners, 1);
    const auto packed = pack(grid, {"gyroid", grid.point_fields[0].values, false, {}});
    ASSERT_FALSE(packed);
    EXPECT_NE(packed.error().message.find("linearize()"), std::string::npos) << packed.error().message;
}

TEST(Polyhedra, OfManyPointsAFaceEndInTime) {
    std::vector<std::array<double, 2>> star; // every fan folds
    for (int i = 0; i < 3000; ++i) {
        const double angle = i * 2e-3, radius = i % 2 ? 1 : 0.2;
        star.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    EXPECT_EQ(linearize(prism(star)).value().report.centred, 1u);
}

} // namespace
} // namespace isotet::test
