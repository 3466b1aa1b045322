// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Node orders of quadratic cells in the formats that are read here: a quadratic field must stay what it is.
#include <gtest/gtest.h>

#include <fmt/core.h>

#include <isotet/read.hpp>

#include "io/gmsh/read_gmsh.hpp"
#include "io/tetgen/read_tetgen.hpp"
#include "support/quadratic_files.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

/// The mean of corners, each as often as its number says.
std::string corners_times(std::initializer_list<std::size_t> times) {
    std::string out;
    char corner = '0';
    for (const std::size_t count : times) out += std::string(count, corner++);
    return out;
}

/// Pyramids of order 3 and 4: edges, triangles, the base from corner 0 towards 3 and 1, then a smaller pyramid.
std::vector<CellInFile> gmsh_pyramids() {
    std::vector<CellInFile> out{{"118", 5, {}}, {"119", 5, {}}};
    const auto add_node = [](CellInFile& cell, const std::string& corners) { cell.middles.push_back(corners); };
    for (std::size_t order : {3u, 4u}) {
        CellInFile& cell = out[order - 3];
        for (const std::string edge : {"01", "03", "04", "12", "14", "23", "24", "34"})
            for (std::size_t i = 1; i < order; ++i)
                add_node(cell, std::string(order - i, edge[0]) + std::string(i, edge[1]));
        for (const std::string face : {"014", "304", "124", "234"}) {
            if (order == 3) add_node(cell, face);
            else
                for (const char nearest : face) add_node(cell, face + nearest);
        }
        const auto add_base = [&](std::size_t to_3, std::size_t to_1) {
            const std::size_t from_3 = order - to_3, from_1 = order - to_1;
            add_node(cell, corners_times({from_3 * from_1, from_3 * to_1, to_3 * to_1, to_3 * from_1}));
        };
        const std::size_t last = order - 1;
        for (const auto& [u, v] : {std::pair<std::size_t, std::size_t>{1, 1}, {last, 1}, {last, last}, {1, last}})
            add_base(u, v);
        if (order == 3) continue;
        for (const auto& [u, v] : {std::pair<std::size_t, std::size_t>{2, 1}, {3, 2}, {2, 3}, {1, 2}, {2, 2}})
            add_base(u, v);
    }
    add_node(out[0], "012344");
    for (const auto& times : {std::array{4, 2, 1, 2}, {2, 4, 2, 1}, {1, 2, 4, 2}, {2, 1, 2, 4}})
        add_node(out[1], corners_times({std::size_t(times[0]), std::size_t(times[1]), std::size_t(times[2]),
                                        std::size_t(times[3]), 3}));
    add_node(out[1], "01234444");
    return out;
}

std::vector<CellInFile> gmsh_cells() {
    const std::vector<std::string> tet{"01", "12", "20", "30", "32", "31"},
        hex{"01", "03", "04", "12", "15", "23", "26", "37", "45", "47", "56", "67"},
        prism{"01", "02", "03", "12", "14", "25", "34", "35", "45"},
        pyramid{"01", "03", "04", "12", "14", "23", "24", "34"};
    auto whole = hex, square = prism, based = pyramid;
    for (const char* face : {"0321", "0154", "0473", "1265", "2376", "4567", "01234567"}) whole.emplace_back(face);
    for (const char* face : {"0143", "0352", "1254"}) square.emplace_back(face);
    based.emplace_back("0123");
    std::vector<CellInFile> all{{"11", 4, tet},   {"12", 8, whole},   {"17", 8, hex},  {"13", 6, square},
                                {"18", 6, prism}, {"19", 5, pyramid}, {"14", 5, based}};
    for (CellInFile& cell : gmsh_pyramids()) all.push_back(std::move(cell));
    return all;
}

std::string node_list(std::size_t count, std::size_t from) {
    std::string out;
    for (std::size_t i = 0; i < count; ++i) out += fmt::format(" {}", i + from);
    return out;
}

std::string gmsh_text(const CellInFile& cell, bool version_4) {
    const auto nodes = nodes_of(cell);
    std::string out =
        version_4 ? fmt::format("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 {0} 1 {0}\n3 1 0 {0}\n", nodes.size())
                  : fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", nodes.size());
    if (version_4)
        for (std::size_t i = 0; i < nodes.size(); ++i) out += fmt::format("{}\n", i + 1);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        if (!version_4) out += fmt::format("{} ", i + 1);
        out += fmt::format("{} {} {}\n", nodes[i][0], nodes[i][1], nodes[i][2]);
    }
    out += "$EndNodes\n$Elements\n";
    out += version_4 ? fmt::format("1 1 1 1\n3 1 {} 1\n1", cell.type) : fmt::format("1\n1 {} 2 1 1", cell.type);
    out += node_list(nodes.size(), 1) + "\n$EndElements\n";
    out += fmt::format("$NodeData\n1\n\"f\"\n1\n0\n3\n0\n1\n{}\n", nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) out += fmt::format("{} {}\n", i + 1, file_quadric(nodes[i]));
    return out + "$EndNodeData\n";
}

TEST(QuadraticFiles, OfGmshHaveTheirNodesWhereGmshPutsThem) {
    for (const CellInFile& cell : gmsh_cells())
        for (const bool version_4 : {false, true}) {
            const auto result = io::parse_gmsh(gmsh_text(cell, version_4), {}, {});
            ASSERT_TRUE(result) << cell.type << ": " << result.error().message;
            expect_exact(result->grid, result->grid.point_fields.at(0).values, cell.corners, "type " + cell.type);
        }
}

TEST(QuadraticFiles, OfTetGenHaveTheirNodesWhereTetGenPutsThem) {
    const std::vector<CellInFile> orders{{"TetGen", 4, {"23", "03", "01", "12", "13", "02"}},
                                         {"VTK", 4, {"01", "12", "20", "03", "13", "23"}}};
    for (const CellInFile& cell : orders) {
        const auto nodes = nodes_of(cell);
        std::string points = "10 3 1 0\n";
        for (std::size_t i = 0; i < nodes.size(); ++i)
            points += fmt::format("{} {} {} {} {}\n", i, nodes[i][0], nodes[i][1], nodes[i][2], file_quadric(nodes[i]));
        const auto result = io::parse_tetgen(points, "1 10 0\n0" + node_list(10, 0) + "\n", {}, {});
        ASSERT_TRUE(result) << result.error().message;
        expect_exact(result->grid, result->grid.point_fields.at(0).values, 4, cell.type);
    }
}

/// VTK 8 had the last two upright edges of Lagrange hexahedra the other way round.
CellInFile as_of_vtk_8(CellInFile cell) {
    if (cell.type == "72") std::swap(cell.middles[10], cell.middles[11]);
    return cell;
}

std::string vtu_text(const CellInFile& cell, const char* version) {
    const auto nodes = nodes_of(cell);
    std::string points, values;
    for (const Position& p : nodes) {
        points += fmt::format("{} {} {} ", p[0], p[1], p[2]);
        values += fmt::format("{} ", vtk_field(cell)(p));
    }
    return fmt::format(
        "<VTKFile type=\"UnstructuredGrid\" version=\"{5}\" byte_order=\"LittleEndian\"><UnstructuredGrid><Piece "
        "NumberOfPoints=\"{0}\" NumberOfCells=\"1\"><PointData><DataArray type=\"Float64\" Name=\"f\" "
        "format=\"ascii\">{1}</DataArray></PointData><Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" "
        "format=\"ascii\">{2}</DataArray></Points><Cells><DataArray type=\"Int64\" Name=\"connectivity\" "
        "format=\"ascii\">{3}</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">{0}</DataArray>"
        "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">{4}</DataArray></Cells></Piece>"
        "</UnstructuredGrid></VTKFile>\n",
        nodes.size(), values, points, node_list(nodes.size(), 0), cell.type, version);
}

std::string legacy_text(const CellInFile& cell) {
    const auto nodes = nodes_of(cell);
    std::string out = fmt::format("# vtk DataFile Version 3.0\none cell\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} "
                                  "double\n",
                                  nodes.size());
    for (const Position& p : nodes) out += fmt::format("{} {} {}\n", p[0], p[1], p[2]);
    out += fmt::format("CELLS 1 {}\n{}{}\nCELL_TYPES 1\n{}\n", nodes.size() + 1, nodes.size(),
                       node_list(nodes.size(), 0), cell.type);
    out += fmt::format("POINT_DATA {}\nSCALARS f double 1\nLOOKUP_TABLE default\n", nodes.size());
    for (const Position& p : nodes) out += fmt::format("{}\n", vtk_field(cell)(p));
    return out;
}

TEST(QuadraticFiles, OfVtkHaveTheirNodesWhereVtkPutsThem) {
    const TemporaryFolder folder;
    for (const CellInFile& cell : vtk_cells())
        for (const auto& [name, text] :
             {std::pair{"a.vtu", vtu_text(cell, "2.2")}, std::pair{"b.vtu", vtu_text(as_of_vtk_8(cell), "1.0")},
              std::pair{"a.vtk", legacy_text(as_of_vtk_8(cell))}}) {
            const auto result = read(folder.write(name, text));
            ASSERT_TRUE(result) << cell.type << " " << name << ": " << result.error().message;
            expect_exact(result->grid, result->grid.point_fields.at(0).values, cell.corners,
                         fmt::format("type {} in {}", cell.type, name), vtk_field(cell));
        }
}

TEST(QuadraticFiles, WithRationalBezierCellsAreRefused) {
    const TemporaryFolder folder;
    std::string text = vtu_text({"78", 4, {"01", "12", "20", "03", "13", "23"}}, "2.2");
    EXPECT_TRUE(read(folder.write("plain.vtu", text)));
    text.replace(text.find("Name=\"f\""), 8, "Name=\"RationalWeights\"");
    const auto result = read(folder.write("rational.vtu", text));
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("rational"), std::string::npos) << result.error().message;
}

} // namespace
} // namespace isotet::test
