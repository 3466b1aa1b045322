// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Faces of polyhedra in VTU files, in both forms, whole and broken.
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/linear_cells.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "support/places.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

std::string face_array(std::string_view name, std::string_view values, std::string_view type = "Int64") {
    return fmt::format("<DataArray type=\"{}\" Name=\"{}\" format=\"ascii\">{}</DataArray>\n", type, name, values);
}

/// A tetrahedron as it is, then one by its faces.
struct FacesFile {
    std::string faces = "4 3 1 2 3 3 1 2 4 3 1 3 4 3 2 3 4", faceoffsets = "-1 17";
    std::string shared = {}; ///< arrays of VTK 9.4 instead
    int pieces = 1;

    std::string text() const {
        const std::string arrays =
            shared.empty() ? face_array("faces", faces) + face_array("faceoffsets", faceoffsets) : shared;
        const auto piece = [&](int above) {
            const int z = 2 * above;
            return "<Piece NumberOfPoints=\"5\" NumberOfCells=\"2\"><PointData/><Points><DataArray type=\"Float64\" "
                   "NumberOfComponents=\"3\" format=\"ascii\">" +
                   fmt::format("0 0 {0} 1 0 {0} 0 1 {0} 0 0 {1} 1 1 {1}", z, z + 1) + "</DataArray></Points><Cells>" +
                   face_array("connectivity", "0 1 2 3 1 2 3 4") + face_array("offsets", "4 8") +
                   face_array("types", "10 42", "UInt8") + arrays + "</Cells></Piece>";
        };
        std::string all;
        for (int i = 0; i < pieces; ++i) all += piece(i);
        return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid>" + all + "</UnstructuredGrid></VTKFile>";
    }
};

Result<ReadResult> read_faces_file(const std::string& text) {
    const TemporaryFolder folder;
    const std::string path = folder.file("faces.vtu");
    std::ofstream(path) << text;
    return read(path);
}

std::string error_of_faces(const FacesFile& file) {
    const auto result = read_faces_file(file.text());
    return result ? "no error" : result.error().message.substr(result.error().message.find(".vtu: ") + 6);
}

std::string shared_faces(std::string_view connectivity, std::string_view offsets, std::string_view to_faces,
                         std::string_view cell_offsets) {
    return face_array("face_connectivity", connectivity) + face_array("face_offsets", offsets) +
           face_array("polyhedron_to_faces", to_faces) + face_array("polyhedron_offsets", cell_offsets);
}

void expect_two_tets(const Grid& grid, std::size_t pieces) {
    const auto linear = linearize(grid);
    ASSERT_TRUE(linear) << linear.error().message;
    EXPECT_EQ(linear->report.known_shapes, pieces);
    EXPECT_EQ(survey(grid).value().tets, 2 * pieces);
    EXPECT_EQ(survey(grid).value().lower[0], 0);
    EXPECT_EQ(survey(grid).value().upper[0], 1);
}

TEST(VtuPolyhedra, HaveTheirFacesInStreams) { expect_two_tets(read_faces_file(FacesFile().text()).value().grid, 1); }

TEST(VtuPolyhedra, HaveSharedFacesSinceVtk94) {
    const std::string shared = shared_faces("1 2 3 1 2 4 1 3 4 2 3 4", "3 6 9 12", "3 2 1 0", "0 4");
    expect_two_tets(read_faces_file(FacesFile{.shared = shared}.text()).value().grid, 1);
}

TEST(VtuPolyhedra, ArePartsOfSeveralPieces) {
    expect_two_tets(read_faces_file(FacesFile{.pieces = 3}.text()).value().grid, 3);
}

TEST(VtuPolyhedra, WithoutFacesAreLeftOut) {
    const Grid grid = read_faces_file(FacesFile{.shared = " "}.text()).value().grid;
    EXPECT_FALSE(has_cells_to_linearize(grid.cells));
    EXPECT_EQ(survey(grid).value().cells_left_out, 1u);
}

TEST(VtuPolyhedra, WithBrokenStreamsAreErrors) {
    EXPECT_EQ(error_of_faces({}), "no error");
    EXPECT_EQ(error_of_faces({.faceoffsets = "17 3"}), "Cells 'faceoffsets' falls");
    EXPECT_EQ(error_of_faces({.faceoffsets = "-1 16"}),
              "cells[1] (polyhedron) has 4 faces, but its 16 entries end in face 3");
    EXPECT_EQ(error_of_faces({.faces = "4 3 1 2 3 3 1 2 4 3 1 3 4 3 2 3 5"}),
              "cells[1] (polyhedron) has a face with point 5, but the grid has 5 points");
    EXPECT_EQ(error_of_faces({.faces = "4 3 1 2 3 3 1 2 4 3 1 3 4 3 2 3 -4"}),
              "cells[1] (polyhedron) has a face with point -4, but the grid has 5 points");
    EXPECT_EQ(error_of_faces({.faces = "9000000000000000000 3 1 2 3 3 1 2 4 3 1 3 4 3 2 3 4"}),
              "cells[1] (polyhedron) has 9000000000000000000 faces, but its 17 entries end in face 4");
    EXPECT_NE(error_of_faces({.faceoffsets = "-1 170000"}), "no error");
    EXPECT_NE(error_of_faces({.faceoffsets = "-1"}), "no error");
    const std::string of_pieces = error_of_faces({.faces = "4 3 1 2 3 3 1 2 4 3 1 3 4 3 2 3 5", .pieces = 2});
    EXPECT_NE(of_pieces.find("piece 1\": cell 1 of a piece has a face with point 5, but the grid has 5 points"),
              std::string::npos)
        << of_pieces;
}

TEST(VtuPolyhedra, WithBrokenSharedFacesAreErrors) {
    const auto error = [](std::string_view connectivity, std::string_view offsets, std::string_view to_faces,
                          std::string_view cell_offsets) {
        return error_of_faces({.shared = shared_faces(connectivity, offsets, to_faces, cell_offsets)});
    };
    constexpr std::string_view points = "1 2 3 1 2 4 1 3 4 2 3 4";
    EXPECT_NE(error(points, "3 6 9 12", "3 2 1 9", "0 4"), "no error");
    EXPECT_EQ(error(points, "3 6 9 12", "3 2 1 -1", "0 4"), "a polyhedron has face -1, but there are 4 faces");
    EXPECT_EQ(error(points, "3 9 6 12", "3 2 1 0", "0 4"),
              "face 2 has points 9 to 6 of 12, but offsets must not fall or leave the list");
    EXPECT_EQ(error(points, "-3 6 9 12", "3 2 1 0", "0 4"),
              "face 0 has points 0 to -3 of 12, but offsets must not fall or leave the list");
    EXPECT_EQ(error(points, "3 6 9 12", "3 2 1 0", "5 4"),
              "cell 0 has faces 0 to 5 of 4, but offsets must not fall or leave the list");
    EXPECT_NE(error(points, "3 6 9 13", "3 2 1 0", "0 4"), "no error");
    EXPECT_EQ(error("1 2 3 1 2 4 1 3 4 2 3 5", "3 6 9 12", "3 2 1 0", "0 4"),
              "cells[1] (polyhedron) has a face with point 5, but the grid has 5 points");
    EXPECT_NE(error(points, "3 6 9 12", "3 2 1 0", "0 9223372036854775807"), "no error");
}

TEST(VtuPolyhedra, OfARealFileAreContoured) {
    const auto result = read((source_folder() / "data/vtu/polyhedron_two_pieces.vtu").string());
    ASSERT_TRUE(result) << result.error().message;
    const auto linear = linearize(result->grid);
    ASSERT_TRUE(linear) << linear.error().message;
    EXPECT_EQ(linear->report.polyhedra, 2u);
    EXPECT_EQ(linear->report.open, 0u);
    EXPECT_EQ(survey(linear->grid).value().cells_left_out, 0u);
}

} // namespace
} // namespace isotet::test
