// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Levels of refinement across pieces: of files, and of a program that gives each piece ghost cells.
#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/pieces.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "pieces/partition.hpp"
#include "support/small_grid.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

Surface surface_of_session(const ContourInput& input, double isovalue, const std::optional<Frame>& frame = {}) {
    ContourOptions options;
    options.frame = frame;
    return Contour::create(input, options).value().extract(isovalue).value().surfaces[0].surface;
}

TEST(PiecesWithLevels, AreClosedWhenTheirFilesAreRead) {
    for (const char* shape : {"octree", "octree-random", "octree-tets"})
        for (const std::uint32_t seed : {1U, 2U}) {
            const Grid grid = made_grid(shape, 3, {"sphere"}, seed);
            const TemporaryFolder folder;
            std::string index = "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid GhostLevel=\"0\">\n";
            int number = 0;
            for (const GridPiece& piece : partition(grid, point_field(grid), 4, seed)) {
                const std::string name = "piece-" + std::to_string(number++) + ".vtu";
                Grid part = piece.grid;
                part.point_numbers = {};
                part.point_fields = {{"sphere", piece.field.values}};
                ASSERT_TRUE(write_grid(part, folder.file(name)));
                index += "<Piece Source=\"" + name + "\"/>\n";
            }
            const Grid joined = read(folder.write("a.pvtu", index + "</PUnstructuredGrid></VTKFile>\n")).value().grid;
            const ClosedGrid closed = close_hanging_points(joined).value(),
                             expected = close_hanging_points(grid).value();
            EXPECT_GT(expected.report.points, 0U);
            EXPECT_EQ(closed.report.points, expected.report.points);
            EXPECT_EQ(closed.report.open_faces, 0U);
            const Surface surface = surface_of_session({closed.grid, point_field(closed.grid), {}, {}}, 0.55);
            EXPECT_TRUE(check(surface).value().closed) << shape << ", seed " << seed;
        }
}

/// A piece with two layers of ghost cells: what hangs on an edge may only be told by a face of a neighbour, whose
/// smaller cells share no point with the piece.
struct PieceWithGhosts {
    GridPiece piece;
    Array ghosts;
};

/// The cells that share a point with some.
std::vector<std::uint64_t> with_neighbours(const core::CellReader& reader, const std::vector<std::uint64_t>& cells) {
    std::set<std::uint64_t> points;
    const auto each_corner = [&](std::uint64_t cell, const auto& use) {
        for (std::uint64_t i = 0; i < reader.corners(cell); ++i) use(reader.corner(reader.first(cell) + i));
    };
    for (const std::uint64_t cell : cells) each_corner(cell, [&](std::uint64_t point) { points.insert(point); });
    std::vector<std::uint64_t> out;
    for (std::uint64_t cell = 0; cell < reader.count(); ++cell) {
        bool shares = false;
        each_corner(cell, [&](std::uint64_t point) { shares |= points.contains(point); });
        if (shares) out.push_back(cell);
    }
    return out;
}

std::vector<PieceWithGhosts> pieces_with_ghosts(const Grid& whole, const PointField& field, std::uint32_t seed) {
    std::mt19937 random(seed);
    const core::CellReader reader = core::CellReader::open(whole).value();
    std::vector<PieceWithGhosts> out;
    for (const GridPiece& own : partition(whole, field, 3, seed)) {
        const std::set<std::uint64_t> owned(own.cells.begin(), own.cells.end());
        const auto cells = with_neighbours(reader, with_neighbours(reader, own.cells));
        std::vector<std::uint8_t> ghosts;
        for (const std::uint64_t cell : cells) ghosts.push_back(owned.contains(cell) ? 0 : 1);
        out.push_back({piece_of(whole, field, cells, random), Array::own(std::move(ghosts))});
    }
    return out;
}

TEST(PiecesWithLevels, ClosedWithTwoLayersOfGhostCellsGiveTheSurfaceOfTheWhole) {
    for (const std::uint32_t seed : {1U, 2U, 3U, 4U}) {
        const Grid whole = made_grid("octree", 4, {"gyroid"}, seed);
        const PointField field = point_field(whole);
        const auto expected =
            triangle_set(surface_of_session({close_hanging_points(whole).value().grid, field, {}, {}}, 0.3));
        ASSERT_GT(expected.size(), 100U);
        std::vector<ContourInput> inputs;
        std::vector<Survey> surveys;
        for (const auto& [piece, ghosts] : pieces_with_ghosts(whole, field, seed)) {
            const Grid closed = close_hanging_points(piece.grid).value().grid;
            inputs.push_back({leave_out_cells(closed, ghosts).value(), piece.field, {}, {}});
            surveys.push_back(survey_piece(inputs.back()).value());
        }
        const Frame frame = make_frame(surveys).value();
        std::vector<TriangleBits> together;
        for (const ContourInput& input : inputs) add_triangles(surface_of_session(input, 0.3, frame), together);
        EXPECT_TRUE(sorted(std::move(together)) == expected) << "seed " << seed;
    }
}

} // namespace
} // namespace isotet::test
