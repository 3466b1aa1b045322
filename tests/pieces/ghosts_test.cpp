// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// With a layer of ghost cells pieces have the gradient normals and the averaged cell fields of the whole, bit for bit.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include <isotet/fields.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>
#include <isotet/pieces.hpp>

#include "pieces/partition.hpp"
#include "support/engines.hpp"
#include "support/mixed_grid.hpp"
#include "support/seeds.hpp"

namespace isotet::test {
namespace {

struct GhostPiece {
    GridPiece piece;
    Array ghosts;
};

/// Pieces with all cells that share a point with their own.
std::vector<GhostPiece> with_ghosts(const Grid& whole, const PointField& field, std::size_t pieces,
                                    std::uint32_t seed) {
    std::mt19937 random(seed);
    const core::CellReader reader = core::CellReader::open(whole).value();
    std::vector<GhostPiece> out;
    for (const GridPiece& own : partition(whole, field, pieces, seed)) {
        const std::set<std::uint64_t> points(own.points.begin(), own.points.end());
        const std::set<std::uint64_t> owned(own.cells.begin(), own.cells.end());
        std::vector<std::uint64_t> cells;
        for (std::uint64_t cell = 0; cell < reader.count(); ++cell)
            for (std::uint64_t i = 0; i < reader.corners(cell); ++i)
                if (points.contains(reader.corner(reader.first(cell) + i))) {
                    cells.push_back(cell);
                    break;
                }
        std::shuffle(cells.begin(), cells.end(), random);
        GhostPiece& piece = out.emplace_back(GhostPiece{piece_of(whole, field, cells, random), {}});
        std::vector<std::uint8_t> ghosts;
        for (const std::uint64_t cell : cells) ghosts.push_back(owned.contains(cell) ? 0 : 1);
        piece.ghosts = Array::own(std::move(ghosts));
    }
    return out;
}

Frame frame_without_ghosts(const std::vector<GhostPiece>& pieces) {
    std::vector<Survey> surveys;
    for (const GhostPiece& piece : pieces)
        surveys.push_back(
            survey_piece(leave_out_cells(piece.piece.grid, piece.ghosts).value(), piece.piece.field).value());
    return make_frame(surveys).value();
}

using Normals3 = std::map<std::array<std::uint64_t, 3>, std::set<std::array<double, 3>>>;

void add_normals(const Surface& surface, Normals3& out) {
    for (std::size_t v = 0; v < surface.vertex_count(); ++v) {
        std::array<std::uint64_t, 3> place;
        std::array<double, 3> normal;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            place[axis] = std::bit_cast<std::uint64_t>(surface.positions.at(v, axis));
            normal[axis] = surface.normals.at(v, axis);
        }
        out[place].insert(normal);
    }
}

TEST(GhostCells, GiveTheGradientNormalsOfTheWhole) {
    for (const std::uint32_t seed : Seeds(1, 4)) {
        const NastyGrid g = mixed_grid(seed, {.side = 5, .values = 0, .moved = 0.1, .wide = seed % 2 == 0});
        const auto pieces = with_ghosts(g.grid, g.field, 3, seed);
        const Frame frame = frame_without_ghosts(pieces);
        const double isovalue = 0.123;
        ExtractOptions extract_options;
        extract_options.normals = Normals::gradient;
        extract_options.source_cells = true;
        const PackOptions pack_options{.source_cells = true, .gradients = true, .frame = frame};
        DirectOptions direct_options;
        direct_options.extract = extract_options;
        direct_options.frame = frame;
        const auto directly = [&](Engine engine, const Grid& grid, const PointField& field) {
            return extract_direct_on(engine, grid, field, std::span(&isovalue, 1), direct_options)
                .value()
                .surfaces[0]
                .surface;
        };

        Normals3 whole, packed, direct, slow;
        add_normals(extract(pack(g.grid, g.field, pack_options).value(), isovalue, extract_options).value().surface,
                    whole);
        Normals3 whole_direct;
        add_normals(directly(Engine::cpu, g.grid, g.field), whole_direct);
        std::vector<TriangleBits> together;
        for (const auto& [piece, ghosts] : pieces) {
            const auto add = [&](const Surface& surface, Normals3& normals) {
                const Surface own = leave_out_triangles(surface, ghosts).value();
                add_normals(own, normals);
                return own;
            };
            const PackedGrid part = pack(piece.grid, piece.field, pack_options).value();
            add_triangles(add(extract(part, isovalue, extract_options).value().surface, packed), together);
            add(directly(Engine::cpu, piece.grid, piece.field), direct);
            add(directly(Engine::reference, piece.grid, piece.field), slow);
        }
        ASSERT_GT(whole.size(), 100u);
        EXPECT_TRUE(packed == whole);
        EXPECT_TRUE(direct == whole_direct);
        EXPECT_TRUE(slow == whole_direct);
        EXPECT_TRUE(sorted(std::move(together)) ==
                    triangle_set(extract(pack(g.grid, g.field).value(), isovalue).value().surface));
    }
}

TEST(GhostCells, GiveTheAveragesOfTheWhole) {
    for (const std::uint32_t seed : Seeds(1, 4)) {
        NastyGrid g = mixed_grid(seed, {.side = 4, .moved = 0.3});
        std::mt19937 random(seed);
        std::vector<double> densities(g.grid.cells.count());
        for (double& density : densities) density = std::uniform_real_distribution<double>(-3, 5)(random);
        const Array density = Array::own(densities);
        Grid whole = g.grid;
        whole.cell_fields = {{"density", density}};
        const FindFieldOptions options{.for_pieces = true};
        const PointField of_whole = find_field(whole, "density", options).value();
        std::size_t compared = 0;
        for (auto& [piece, ghosts] : with_ghosts(g.grid, g.field, 3, seed)) {
            Grid grid = piece.grid;
            grid.cell_fields = {{"density", taken(density, piece.cells)}};
            const Array averages = find_field(grid, "density", options).value().values;
            const core::CellReader reader = core::CellReader::open(grid).value();
            for (std::size_t cell = 0; cell < reader.count(); ++cell)
                for (std::uint64_t i = 0; ghosts.at(cell) == 0 && i < reader.corners(cell); ++i, ++compared) {
                    const std::uint64_t point = reader.corner(reader.first(cell) + i);
                    ASSERT_EQ(averages.at(point), of_whole.values.at(piece.points[point]));
                }
        }
        EXPECT_GT(compared, 100u);
    }
}

} // namespace
} // namespace isotet::test
