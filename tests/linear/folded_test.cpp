// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polyhedra that are badly shaped: hanging points beside their line, faces that share more than an edge, cells of which no
// point sees all faces. Surfaces stay closed, and no face inside the grid counts as its boundary.
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/boundary.hpp>
#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/solid.hpp>

#include "grid/cells.hpp"
#include "linear/polyhedral_grid.hpp"
#include "support/surface_sets.hpp"

namespace isotet::test {
namespace {

PointField whole_numbers(const Grid& grid, unsigned seed, unsigned values) {
    std::mt19937 random(seed);
    std::vector<double> out(grid.points.tuples());
    for (double& value : out) value = static_cast<double>(random() % values);
    return {"value", Array::own(std::move(out)), false, {}};
}

SurfaceReport checked(const Grid& grid, const PointField& field, const ContourOptions& options, double isovalue) {
    const auto result = Contour::create({grid, field, {}, {}}, options).value().extract(isovalue).value();
    return check(result.surfaces[0].surface, {.grid = &grid, .field = &field, .split_cells = options.split_cells})
        .value();
}

/// Sound by both methods, whole and split.
void expect_sound(const Grid& grid, const PointField& field, double isovalue, const std::string& what) {
    for (const bool split_cells : {false, true})
        for (const Method method : {Method::direct, Method::clusters}) {
            ContourOptions options;
            options.method = method;
            options.split_cells = split_cells;
            options.edge_ends = true;
            const SurfaceReport report = checked(grid, field, options, isovalue);
            EXPECT_TRUE(report.sound) << what << ", isovalue " << isovalue << ": "
                                      << (report.findings.empty() ? "" : report.findings[0].what);
        }
}

Grid one_cell(std::vector<double> places, const CellFaces& faces) {
    PolyhedronList list;
    list.add(faces);
    Grid grid;
    grid.points = Array::own(std::move(places), 3);
    grid.cells = list.cells();
    return grid;
}

/// Triangles of the faces that one cell has, each face of n points being n - 2 of them.
std::size_t single_face_triangles(const Grid& grid) {
    std::map<std::vector<std::uint64_t>, std::pair<int, std::size_t>> faces;
    const auto add = [&](std::vector<std::uint64_t> points) {
        const std::size_t triangles = points.size() - 2;
        std::ranges::sort(points);
        auto& face = faces[points];
        ++face.first;
        face.second = triangles;
    };
    const core::CellReader reader = core::CellReader::open(grid).value();
    const auto listed = grid.cells.faces.as<std::int64_t>();
    const auto ends = grid.cells.face_offsets.as<std::int64_t>();
    for (std::size_t cell = 0; cell < reader.count(); ++cell) {
        if (reader.type(cell) != 42) {
            const core::WholeCell whole = reader.whole(cell);
            for (const core::CellFace& face : core::shape_of(whole.kind).faces()) {
                std::vector<std::uint64_t> points;
                for (const std::uint8_t corner : face.all()) points.push_back(whole.corners[corner]);
                add(points);
            }
            continue;
        }
        for (auto at = static_cast<std::size_t>(ends[cell]) + 1; at < static_cast<std::size_t>(ends[cell + 1]);) {
            const auto count = static_cast<std::size_t>(listed[at]);
            add({listed.begin() + static_cast<std::ptrdiff_t>(at + 1),
                 listed.begin() + static_cast<std::ptrdiff_t>(at + 1 + count)});
            at += count + 1;
        }
    }
    std::size_t triangles = 0;
    for (const auto& [points, face] : faces)
        if (face.first == 1) triangles += face.second;
    return triangles;
}

TEST(HangingPoints, OffTheirLineByRoundingGiveNoTriangleWithoutAnArea) {
    // A cube of OpenFOAM's, of which one edge has a point in its middle.
    Grid grid = one_cell({0.03125,  0.34375, 0.09375, 0.0625,  0.375,    0.125, 0.0625,  0.375,               0.09375,
                          0.0625,   0.34375, 0.125,   0.03125, 0.375,    0.125, 0.0625,  0.34375,             0.09375000000000001,
                          0.03125,  0.375,   0.09375000000000001, 0.03125, 0.34375, 0.125, 0.046875, 0.34375, 0.09375},
                         {{1, 4, 7, 3}, {6, 2, 5, 8, 0}, {7, 0, 8, 5, 3}, {4, 7, 0, 6}, {1, 3, 5, 2}, {1, 2, 6, 4}});
    const LinearGrid linear = linearize(grid).value();
    EXPECT_EQ(linear.report.folded, 0u);
    const GridReport report = survey(linear.grid).value();
    EXPECT_EQ(report.tets, 14u);
    EXPECT_EQ(report.flat_tets + report.inverted_tets + report.repeated_tets, 0u);
    const PointField field{"f", Array::own(std::vector<double>{0, 0, 0, 0, 0, 0, 0, 0, 1}), false, {}};
    for (const double isovalue : {0.1, 0.3, 0.9}) expect_sound(grid, field, isovalue, "cube");
}

TEST(HangingPoints, NearTheirLineLeaveNoTetFlatOrInverted) {
    for (const double moved : {1e-16, 1e-13, 1e-9, 1e-6, 1e-4})
        for (unsigned seed = 1; seed <= 6; ++seed) {
            Grid grid = octree_grid({.seed = seed, .moved = moved});
            const LinearGrid linear = linearize(grid).value();
            const GridReport report = survey(linear.grid).value();
            EXPECT_EQ(report.flat_tets + report.inverted_tets + report.repeated_tets, 0u) << moved << ", seed " << seed;
            EXPECT_EQ(report.boundary_faces, single_face_triangles(grid)) << moved << ", seed " << seed;
        }
}

TEST(FacesOfACell, ThatShareTwoEdgesMeetWithoutATriangleOfTheirOwn) {
    // A cell of snappyHexMesh's: point 8 is in two faces only, and both cut it off.
    const Grid grid = one_cell(
        {-1.9997369516269268, -1.9998321352420958, 0.1313257517298303,  -1.4995781285512053, -1.499775125555261,
         0.5549412753837815,  -1.4996638209045883, -1.9997158775686006, 0.11602528074668499, -1.9996432109519506,
         -1.4998481375341373, 0.1160294578425482,  -1.9997642230813306, -1.9998550424106456, 0.6057123549752405,
         -1.4997003985524004, -1.9997604659639745, 0.5896283507878358,  -1.999683335262706,  -1.4998750730148036,
         0.5908532295615073,  -1.4995284772028463, -1.4997214670763306, 0.0749999999999998,  -1.4994977302520405,
         -1.499718973022308,  0.31388027863945955},
        {{0, 2, 5, 4}, {0, 4, 6, 3}, {5, 2, 7, 8, 1}, {7, 3, 6, 1, 8}, {6, 4, 5, 1}, {0, 3, 7, 2}});
    for (std::size_t apex = 0; apex < 9; ++apex) {
        std::vector<double> values(9, 0);
        values[apex] = 1;
        const PointField field{"f", Array::own(std::move(values)), false, {}};
        for (const double isovalue : {0.05, 0.3, 0.9}) {
            expect_sound(grid, field, isovalue, "point " + std::to_string(apex));
            EXPECT_TRUE(checked(grid, field, {.edge_ends = true}, isovalue).clean);
        }
    }
    EXPECT_EQ(survey(linearize(grid).value().grid).value().repeated_tets, 0u);
}

TEST(FacesOfACell, ThatCancelLeaveNothingOfAFlatCell) {
    // Two triangles and two that repeat them.
    const Grid grid = one_cell({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}, {{0, 1, 2}, {1, 3, 2}, {0, 2, 1}, {1, 2, 3}});
    const auto linear = linearize(grid);
    EXPECT_FALSE(linear) << "no cell is left";
}

TEST(BadlyShapedPolyhedra, GiveSoundSurfaces) {
    for (const double moved : {1e-16, 1e-7, 1e-3, 0.1, 0.3, 0.6, 2.0})
        for (unsigned seed = 1; seed <= 3; ++seed) {
            const Grid grid = octree_grid({.seed = seed, .moved = moved});
            const PointField field = whole_numbers(grid, seed, 5);
            for (const double isovalue : {1.0, 2.5})
                expect_sound(grid, field, isovalue, "moved " + std::to_string(moved) + ", seed " + std::to_string(seed));
        }
}

TEST(BadlyShapedPolyhedra, OfSinglePrecisionGiveSoundSurfaces) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
        Grid grid = octree_grid({.seed = seed, .moved = 0.3});
        std::vector<float> places;
        for (const double x : grid.points.as<double>()) places.push_back(static_cast<float>(x + 1000));
        grid.points = Array::own(std::move(places), 3);
        expect_sound(grid, whole_numbers(grid, seed, 4), 1.5, "seed " + std::to_string(seed));
    }
}

TEST(BadlyShapedPolyhedra, HaveTheBoundaryOfTheFacesThatOneCellHas) {
    std::uint64_t folded = 0;
    for (unsigned seed = 1; seed <= 8; ++seed) {
        const Grid grid = octree_grid({.seed = seed, .moved = 0.35});
        folded += linearize(grid).value().report.folded;
        const Surface boundary = boundary_of(grid).value();
        EXPECT_EQ(boundary.triangle_count(), single_face_triangles(grid)) << "seed " << seed;
        EXPECT_EQ(survey(grid).value().boundary_faces, boundary.triangle_count());
        EXPECT_TRUE(check(boundary, {.closed = true}).value().closed);
    }
    EXPECT_GT(folded, 0u) << "some cells must be folded for this to say anything";
}

TEST(BadlyShapedPolyhedra, GiveSolidsWithThatBoundary) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
        const Grid grid = octree_grid({.seed = seed, .moved = 0.35});
        Solids solids = Solids::create({grid, whole_numbers(grid, seed, 4), {}, {}}).value();
        const Solid all = solids.extract(SolidRange::above(-1)).value();
        EXPECT_EQ(all.surface.triangle_count(), single_face_triangles(grid)) << "seed " << seed;
        EXPECT_EQ(all.open_edges, 0u);
    }
}

} // namespace
} // namespace isotet::test
