// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Solids and clipped cells against slow references, cell by cell, with all ways to put corners below, at and above the
// isovalue.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include <isotet/isovalues.hpp>
#include <isotet/solid.hpp>

#include "solid/all_cases.hpp"
#include "solid/cell_boundary.hpp"
#include "solid/reference.hpp"
#include "support/mixed_grid.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"

namespace isotet::test {
namespace {

ContourOptions exact_with_ends() {
    ContourOptions options{.precision = Precision::float64};
    options.edge_ends = options.source_cells = true;
    return options;
}

std::set<std::uint64_t> cells_of(const ByCell& some, const ByCell& others) {
    std::set<std::uint64_t> out;
    for (const ByCell* polygons : {&some, &others})
        for (const auto& [cell, of_cell] : *polygons) out.insert(cell);
    return out;
}

std::vector<NamedPolygon> without(const std::vector<NamedPolygon>& polygons, const std::vector<NamedPolygon>& others) {
    std::multiset<NamedPolygon> out(polygons.begin(), polygons.end());
    for (const NamedPolygon& other : others)
        if (const auto found = out.find(other); found != out.end()) out.erase(found);
    return {out.begin(), out.end()};
}

NamedPolygon turned(NamedPolygon polygon) {
    std::ranges::reverse(polygon);
    return plain(std::move(polygon));
}

/// Whether it may be of a double sheet, of which the reference has both sides and the solid none.
bool has_tied_vertex(const PlainField& field, const NamedPolygon& polygon) {
    return std::ranges::any_of(polygon, [&](const VertexName& name) {
        return name.first == name.second && name.first >= 0 && field.is_tied(static_cast<std::uint64_t>(name.first));
    });
}

/// The triangles of the isosurface are the reference's, those of the boundary fill the reference's polygons; what is missing at
/// ties is closed.
void expect_solid(const NastyGrid& g, Solids& solids, OneSide side, const ReferenceSolid& reference) {
    const Solid solid = solids.extract(side.range()).value();
    EXPECT_EQ(solid.open_edges, 0u);
    const Surface& surface = solid.surface;
    const PlainField field(g.field.values, side);
    ByCell isosurface = triangles_by_cell(surface, 0, solid.isosurface_triangles);
    const ByCell boundary = triangles_by_cell(surface, solid.isosurface_triangles, surface.triangle_count());
    std::size_t other_isosurface = 0, other_boundary = 0, open = 0;
    EdgeChain missing;
    for (std::uint64_t cell = 0; cell < g.grid.cells.count(); ++cell) {
        const std::vector<NamedPolygon> found = of_cell(isosurface, cell), wanted = of_cell(reference.isosurface, cell);
        for (const NamedPolygon& triangle : without(found, wanted)) { // one side of a double sheet had two, the other one
            other_isosurface += !std::ranges::all_of(
                triangle, [&](const VertexName& name) { return has_tied_vertex(field, {name}); });
            missing.add(turned(triangle));
        }
        for (const NamedPolygon& triangle : without(wanted, found)) {
            other_isosurface += !has_tied_vertex(field, triangle);
            missing.add(triangle);
        }
        EdgeChain whole = edges_of(of_cell(reference.all_faces, cell));
        for (const NamedPolygon& triangle : wanted) whole.add(triangle);
        open += !whole.is_closed();
    }
    for (const std::uint64_t cell : cells_of(boundary, reference.boundary)) {
        const std::vector<NamedPolygon> found = of_cell(boundary, cell), wanted = of_cell(reference.boundary, cell);
        const bool is_tied = std::ranges::any_of(
            wanted, [&](const NamedPolygon& polygon) { return has_tied_vertex(field, polygon); });
        other_boundary += !is_tied && !(edges_of(found) == edges_of(wanted));
        for (const NamedPolygon& polygon : wanted) missing.add(polygon);
        for (const NamedPolygon& triangle : found) missing.add(turned(triangle));
    }
    EXPECT_EQ(other_isosurface, 0u);
    EXPECT_EQ(other_boundary, 0u);
    EXPECT_TRUE(missing.is_closed());
    EXPECT_EQ(open, 0u) << "of the reference: the isosurface does not end where the faces are cut";
}

/// The faces of the pieces of each cell, those between two pieces left out.
ByCell faces_of_pieces(const ClippedGrid& clipped) {
    std::map<std::uint64_t, std::multiset<NamedPolygon>> faces;
    const FacesOfCells pieces(clipped.grid);
    for (std::uint64_t piece = 0; piece < pieces.count(); ++piece)
        for (const CellPolygon& face : pieces.of(piece)) {
            NamedPolygon named;
            for (const std::uint64_t vertex : face) named.push_back(name_at(clipped.edge_ends, vertex));
            NamedPolygon back(named.rbegin(), named.rend());
            auto& of_cell = faces[static_cast<std::uint64_t>(clipped.source_cells.at(piece))];
            if (const auto other = of_cell.find(plain(back)); other != of_cell.end()) of_cell.erase(other);
            else of_cell.insert(plain(named));
        }
    ByCell out;
    for (const auto& [cell, some] : faces) out[cell].assign(some.begin(), some.end());
    return out;
}

/// The faces of a cell's pieces are the parts of its faces, but for flat ones at ties, and polygons on the isosurface.
void expect_pieces(const NastyGrid& g, Clipper& clipper, OneSide side, const ReferenceSolid& reference) {
    const ByCell found = faces_of_pieces(clipper.clip(side.range()).value());
    const PlainField field(g.field.values, side);
    const auto is_on_isosurface = [&](const NamedPolygon& polygon) {
        return std::ranges::all_of(polygon, [&](const VertexName& name) { return field.is_on_isosurface(name); });
    };
    std::size_t missing = 0, strange = 0, open = 0;
    for (const std::uint64_t cell : cells_of(found, reference.all_faces)) {
        const std::vector<NamedPolygon> of_pieces = of_cell(found, cell), wanted = of_cell(reference.all_faces, cell);
        const std::vector<NamedPolygon> more = without(of_pieces, wanted), less = without(wanted, of_pieces);
        missing += !std::ranges::all_of(less, is_on_isosurface);
        strange += !std::ranges::all_of(more, is_on_isosurface);
        EdgeChain ends = edges_of(of_cell(reference.isosurface, cell));
        for (const NamedPolygon& polygon : less) ends.add(polygon);
        open += !(ends == edges_of(more));
    }
    EXPECT_EQ(missing, 0u);
    EXPECT_EQ(strange, 0u);
    EXPECT_EQ(open, 0u);
}

void expect_both(const NastyGrid& g, const std::vector<double>& isovalues) {
    const ContourInput input{g.grid, g.field, {{"value", g.field.values}}, {}};
    Solids solids = Solids::create(input, exact_with_ends()).value();
    Clipper clipper = Clipper::create(input, exact_with_ends()).value();
    for (const double isovalue : isovalues)
        for (const bool above : {false, true}) {
            SCOPED_TRACE(testing::Message() << (above ? "above " : "below ") << isovalue);
            const OneSide side{isovalue, above};
            const ReferenceSolid reference = reference_solid(g, side);
            expect_solid(g, solids, side, reference);
            expect_pieces(g, clipper, side, reference);
            if (testing::Test::HasFailure()) return;
        }
}

void expect_volumes(const NastyGrid& g, double isovalue) {
    const ContourInput input{g.grid, g.field, {}, {}};
    Solids solids = Solids::create(input, exact_with_ends()).value();
    const double above = solids.extract(SolidRange::above(isovalue)).value().volume,
                 below = solids.extract(SolidRange::below(isovalue)).value().volume;
    EXPECT_NEAR(above + below, solids.grid_volume(), 1e-9 * solids.grid_volume());
    EXPECT_NEAR(solids.grid_volume(), total_volume(g.grid), 1e-9 * solids.grid_volume());
}

/// The 6,561 cases of hexahedra take minutes where every access is watched.
bool takes_minutes(core::CellKind kind) { return kind == core::CellKind::hexahedron && seed_share > 1; }

TEST(Reference, IsTheSolidAndThePiecesOfEachKindOfCellInEveryCase) {
    for (const core::CellKind kind : core::cell_kinds) {
        if (takes_minutes(kind)) continue;
        SCOPED_TRACE(testing::Message() << core::corner_count(kind) << " corners");
        const NastyGrid g = all_cases(kind);
        expect_both(g, {1});
        expect_volumes(g, 1);
    }
}

TEST(Reference, IsTheSolidAndThePiecesOfNeighboursWithEveryCaseOfTheirFace) {
    for (const core::CellKind kind : core::cell_kinds) {
        if (takes_minutes(kind)) continue;
        SCOPED_TRACE(testing::Message() << core::corner_count(kind) << " corners");
        const NastyGrid g = all_neighbours(kind);
        expect_both(g, {1});
        expect_volumes(g, 1);
    }
}

TEST(Reference, IsTheSolidAndThePiecesOfRandomGrids) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed"})
        for (const std::uint32_t seed : Seeds(800, 2)) {
            SCOPED_TRACE(shape);
            const NastyGrid g = mixed_grid(seed, {.shape = shape,
                                                  .side = 3,
                                                  .values = seed % 2 ? 4 : 0,
                                                  .no_data = 0.01 * (seed % 2),
                                                  .missing = 0.1,
                                                  .mirrored = 0.2,
                                                  .wide = true});
            expect_both(g, {0, 0.5, 1});
        }
    for (const std::uint32_t seed : Seeds(820, 2))
        expect_both(nasty_grid(seed, {.side = 4, .values = 0, .missing = 0.1, .wide = true}), {-0.4, 0.1});
}

TEST(Reference, SplitCellsEncloseTheVolumeOfTheSpectrum) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed"})
        for (const std::uint32_t seed : Seeds(840, 2)) {
            SCOPED_TRACE(shape);
            const NastyGrid g = mixed_grid(seed, {.shape = shape, .side = 4, .values = 0, .moved = 0.1, .wide = true});
            ContourOptions options = exact_with_ends();
            options.split_cells = true;
            Solids solids = Solids::create({g.grid, g.field, {}, {}}, options).value();
            for (const double isovalue : {0.3, 0.8}) {
                const ContourSpectrum spectrum =
                    contour_spectrum(g.grid, g.field, std::vector<double>{isovalue}).value();
                const double below = solids.extract(SolidRange::below(isovalue)).value().volume;
                EXPECT_NEAR(below, spectrum.volume_below[0], 1e-6 * solids.grid_volume());
                EXPECT_GT(below, 0.01 * solids.grid_volume());
            }
        }
}

} // namespace
} // namespace isotet::test
