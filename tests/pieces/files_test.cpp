// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Partitioned files: extracted piece by piece, they give the triangles of the grid that is read from all of them.
#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>
#include <isotet/pieces.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "pieces/partition.hpp"
#include "support/mixed_grid.hpp"
#include "support/small_grid.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

TEST(PartitionedFiles, GiveTheSameTrianglesPieceByPiece) {
    NastyGrid g = mixed_grid(2, {.side = 5, .values = 0, .no_data = 0.01, .moved = 0.1, .wide = true});
    std::vector<double> pressures;
    for (std::size_t i = 0; i < g.field.values.size(); ++i)
        pressures.push_back(101'325 + 20.123 * g.field.values.at(i));
    g.field.values = Array::own(std::move(pressures));
    const double isovalue = 101'326;
    const TemporaryFolder folder;
    std::string index = "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid GhostLevel=\"0\">\n";
    std::vector<std::string> files;
    for (const GridPiece& piece : partition(g.grid, g.field, 3, 2)) {
        const std::string name = "piece-" + std::to_string(files.size()) + ".vtu";
        Grid grid = piece.grid;
        grid.point_fields = {{"value", piece.field.values}};
        ASSERT_TRUE(write_grid(grid, folder.file(name)));
        files.push_back(folder.file(name));
        index += "<Piece Source=\"" + name + "\"/>\n";
    }
    const auto numbered = [](const std::string& file) {
        Grid grid = read(file).value().grid;
        grid.point_numbers = number_points_by_coordinates(grid.points).value();
        return grid;
    };
    const Grid whole = numbered(folder.write("whole.pvtu", index + "</PUnstructuredGrid></VTKFile>\n"));
    ASSERT_EQ(whole.cells.count(), g.grid.cells.count());

    std::vector<Survey> surveys;
    for (const std::string& file : files)
        surveys.push_back(survey_piece(numbered(file), point_field(numbered(file))).value());
    DirectOptions options;
    options.frame = make_frame(surveys).value();
    std::vector<TriangleBits> together;
    for (const std::string& file : files) {
        const Grid piece = numbered(file);
        const auto result = extract_direct(piece, point_field(piece), std::span(&isovalue, 1), options).value();
        add_triangles(result.surfaces[0].surface, together);
    }
    const auto expected = triangle_set(extract(pack(whole, point_field(whole)).value(), isovalue).value().surface);
    EXPECT_GT(expected.size(), 100u);
    EXPECT_TRUE(sorted(std::move(together)) == expected);
}

} // namespace
} // namespace isotet::test
