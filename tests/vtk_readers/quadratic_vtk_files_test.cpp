// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Node orders of quadratic cells in Exodus, CGNS and VTKHDF: a quadratic field must stay what it is.
#include <gtest/gtest.h>

#include <vtkHigherOrderHexahedron.h>
#include <vtkHigherOrderTetra.h>
#include <vtkHigherOrderWedge.h>
#include <vtk_cgns.h>
#include VTK_CGNS(cgnslib.h)
#include <vtk_exodusII.h>

#include <isotet/read.hpp>

#include "grid/cell/node_order.hpp"
#include "vtk_readers/hdf5_writer.hpp"
#include "support/quadratic_files.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

std::vector<std::string> joined(std::vector<std::string> first, const std::vector<std::string>& more) {
    first.insert(first.end(), more.begin(), more.end());
    return first;
}

/// Edges of the bottom, upright ones, those of the top: both formats'.
const std::vector<std::string> tet_middles{"01", "12", "20", "03", "13", "23"},
    hex_middles{"01", "12", "23", "30", "04", "15", "26", "37", "45", "56", "67", "74"},
    wedge_middles{"01", "12", "20", "03", "14", "25", "34", "45", "53"},
    pyramid_middles{"01", "12", "23", "30", "04", "14", "24", "34"}, wedge_squares{"0143", "1254", "2035"};

struct Columns {
    std::array<std::vector<double>, 3> axes;
    std::vector<double> values;
};

Columns columns_of(const CellInFile& cell, const std::function<double(Position)>& field = file_quadric) {
    Columns out;
    for (const Position& p : nodes_of(cell)) {
        for (std::size_t k = 0; k < 3; ++k) out.axes[k].push_back(p[k]);
        out.values.push_back(field(p));
    }
    return out;
}

template <class Integer>
std::vector<Integer> one_to(std::size_t count) {
    std::vector<Integer> out(count);
    for (std::size_t i = 0; i < count; ++i) out[i] = static_cast<Integer>(i + 1);
    return out;
}

void write_exodus_cell(const CellInFile& cell, const std::string& path) {
    const Columns columns = columns_of(cell);
    const auto count = static_cast<std::int64_t>(columns.values.size());
    int word = 8, stored = 8;
    const int file = ex_create(path.c_str(), EX_CLOBBER, &word, &stored);
    ASSERT_GE(file, 0);
    ex_put_init(file, "one cell", 3, count, 1, 1, 0, 0);
    ex_put_coord(file, columns.axes[0].data(), columns.axes[1].data(), columns.axes[2].data());
    ex_put_block(file, EX_ELEM_BLOCK, 1, cell.type.c_str(), 1, count, 0, 0, 0);
    ex_put_conn(file, EX_ELEM_BLOCK, 1, one_to<int>(columns.values.size()).data(), nullptr, nullptr);
    char name[] = "f";
    char* names[] = {name};
    ex_put_variable_param(file, EX_NODAL, 1);
    ex_put_variable_names(file, EX_NODAL, 1, names);
    const double time = 0;
    ex_put_time(file, 1, &time);
    ex_put_var(file, 1, EX_NODAL, 1, 1, count, columns.values.data());
    ASSERT_GE(ex_close(file), 0);
}

TEST(QuadraticFiles, OfExodusHaveTheirNodesWhereExodusPutsThem) {
    const std::vector<CellInFile> cells{
        {"TETRA10", 4, tet_middles},
        {"HEX20", 8, hex_middles},
        {"HEX27", 8, joined(hex_middles, {"01234567", "0123", "4567", "0374", "1265", "0154", "2376"})},
        {"WEDGE15", 6, wedge_middles},
        {"WEDGE18", 6, joined(wedge_middles, wedge_squares)},
        {"PYRAMID13", 5, pyramid_middles},
        {"PYRAMID14", 5, joined(pyramid_middles, {"0123"})}};
    const TemporaryFolder folder;
    for (const CellInFile& cell : cells) {
        const std::string path = folder.file(cell.type + ".e");
        write_exodus_cell(cell, path);
        const auto result = read(path);
        ASSERT_TRUE(result) << cell.type << ": " << result.error().message;
        expect_exact(result->grid, result->grid.point_fields.at(0).values, cell.corners, cell.type);
    }
}

/// VTK has no cell for them: those of their first nodes.
TEST(QuadraticFiles, OfExodusWithNodesInFacesAreReadWithoutThem) {
    const std::vector<std::string> triangles{"014", "124", "234", "304"};
    const std::vector<CellInFile> cells{
        {"TETRA14", 4, joined(tet_middles, {"013", "123", "023", "012"})},
        {"TETRA15", 4, joined(tet_middles, {"0123", "012", "013", "123", "023"})},
        {"HEX21", 8, joined(hex_middles, {"01234567"})},
        {"WEDGE16", 6, joined(wedge_middles, {"012345"})},
        {"WEDGE20", 6, joined(joined(wedge_middles, wedge_squares), {"012", "345"})},
        {"PRISM21", 6, joined(joined(wedge_middles, {"012345", "012", "345"}), wedge_squares)},
        {"PYRAMID18", 5, joined(joined(pyramid_middles, {"0123"}), triangles)},
        {"PYRAMID19", 5, joined(joined(pyramid_middles, {"0123"}), joined(triangles, {"01234"}))}};
    const TemporaryFolder folder;
    for (const CellInFile& cell : cells) {
        const std::string path = folder.file(cell.type + ".e");
        write_exodus_cell(cell, path);
        const auto result = read(path);
        ASSERT_TRUE(result) << cell.type << ": " << result.error().message;
        expect_exact(result->grid, result->grid.point_fields.at(0).values, cell.corners, cell.type);
        ASSERT_EQ(result->notes.size(), 1u) << cell.type;
        EXPECT_NE(result->notes[0].find("without nodes in faces and in the middle: 1 quadratic"), std::string::npos)
            << result->notes[0];
    }
}

void write_cgns_cell(const CellInFile& cell, CG_ElementType_t type, const std::string& path) {
    const Columns columns = columns_of(cell);
    const auto nodes = static_cast<cgsize_t>(columns.values.size());
    int file = 0, base = 0, zone = 0, at = 0, solution = 0;
    ASSERT_EQ(cg_set_file_type(CG_FILE_ADF), 0);
    ASSERT_EQ(cg_open(path.c_str(), CG_MODE_WRITE, &file), 0) << cg_get_error();
    cg_base_write(file, "Base", 3, 3, &base);
    const cgsize_t size[3] = {nodes, 1, 0};
    cg_zone_write(file, base, "Zone", size, CG_Unstructured, &zone);
    const std::array<const char*, 3> names{"CoordinateX", "CoordinateY", "CoordinateZ"};
    for (std::size_t k = 0; k < 3; ++k)
        cg_coord_write(file, base, zone, CG_RealDouble, names[k], columns.axes[k].data(), &at);
    const auto elements = one_to<cgsize_t>(columns.values.size());
    cg_section_write(file, base, zone, "Cells", type, 1, 1, 0, elements.data(), &at);
    cg_sol_write(file, base, zone, "Solution", CG_Vertex, &solution);
    cg_field_write(file, base, zone, solution, CG_RealDouble, "f", columns.values.data(), &at);
    ASSERT_EQ(cg_close(file), 0) << cg_get_error();
}

TEST(QuadraticFiles, OfCgnsHaveTheirNodesWhereCgnsPutsThem) {
    const std::vector<std::pair<CellInFile, CG_ElementType_t>> cells{
        {{"TETRA_10", 4, tet_middles}, CG_TETRA_10},
        {{"HEXA_20", 8, hex_middles}, CG_HEXA_20},
        {{"HEXA_27", 8, joined(hex_middles, {"0123", "0154", "1265", "2376", "0374", "4567", "01234567"})}, CG_HEXA_27},
        {{"PENTA_15", 6, wedge_middles}, CG_PENTA_15},
        {{"PENTA_18", 6, joined(wedge_middles, wedge_squares)}, CG_PENTA_18},
        {{"PYRA_13", 5, pyramid_middles}, CG_PYRA_13},
        {{"PYRA_14", 5, joined(pyramid_middles, {"0123"})}, CG_PYRA_14}};
    const TemporaryFolder folder;
    for (const auto& [cell, type] : cells) {
        const std::string path = folder.file(cell.type + ".cgns");
        write_cgns_cell(cell, type, path);
        const auto result = read(path);
        ASSERT_TRUE(result) << cell.type << ": " << result.error().message;
        expect_exact(result->grid, result->grid.point_fields.at(0).values, cell.corners, cell.type);
        const std::string whole = content_of(path);
        const auto cut = read(folder.write("cut.cgns", whole.substr(0, whole.size() - 4096)));
        ASSERT_FALSE(cut) << cell.type;
        EXPECT_NE(cut.error().message.find("cut short"), std::string::npos) << cut.error().message;
    }
}

TEST(QuadraticFiles, OfVtkhdfHaveTheirNodesWhereVtkPutsThem) {
    const TemporaryFolder folder;
    for (const CellInFile& cell : vtk_cells()) {
        const std::string path = folder.file("t" + cell.type + ".vtkhdf");
        const Columns columns = columns_of(cell, vtk_field(cell));
        std::vector<double> points;
        for (std::size_t i = 0; i < columns.values.size(); ++i)
            for (std::size_t k = 0; k < 3; ++k) points.push_back(columns.axes[k][i]);
        {
            Hdf5Writer file(path);
            write_one_cell(file, static_cast<std::uint8_t>(std::stoi(cell.type)), points, columns.values);
        }
        const auto result = read(path);
        ASSERT_TRUE(result) << cell.type << ": " << result.error().message;
        expect_exact(result->grid, result->grid.point_fields.at(0).values, cell.corners, cell.type, vtk_field(cell));
    }
}

/// Places as Gmsh 4.15 writes these elements.
TEST(NodesOfDegree, OfCgnsStandWhereCgnsPutsThem) {
    using enum core::CellKind;
    const auto at = [](core::CellKind kind, unsigned degree, std::size_t node) {
        return core::nodes_of_degree(kind, degree, core::NodeOrder::cgns)[node - 1];
    };
    using Place = core::LatticePlace;
    EXPECT_EQ(at(tetrahedron, 3, 13), (Place{2, 0, 1}));
    EXPECT_EQ(at(tetrahedron, 3, 18), (Place{1, 0, 1}));
    EXPECT_EQ(at(tetrahedron, 4, 32), (Place{0, 2, 1}));
    EXPECT_EQ(at(hexahedron, 3, 13), (Place{2, 3, 0}));
    EXPECT_EQ(at(hexahedron, 3, 49), (Place{0, 2, 1}));
    EXPECT_EQ(at(hexahedron, 3, 60), (Place{1, 2, 1}));
    EXPECT_EQ(at(hexahedron, 4, 48), (Place{3, 2, 0}));
    EXPECT_EQ(at(hexahedron, 4, 84), (Place{0, 1, 2}));
    EXPECT_EQ(at(hexahedron, 4, 111), (Place{3, 2, 2}));
    EXPECT_EQ(at(wedge, 3, 13), (Place{0, 0, 1}));
    EXPECT_EQ(at(wedge, 3, 36), (Place{0, 1, 2})) << "as VTK 9.7 takes PENTA_40";
}

TEST(NodesOfDegree, StandWhereVtkPutsThem) {
    using enum core::CellKind;
    for (int degree = 1; degree <= 7; ++degree) {
        const auto p = static_cast<unsigned>(degree);
        const auto hex = core::nodes_of_degree(hexahedron, p, core::NodeOrder::vtk);
        const auto prism = core::nodes_of_degree(wedge, p, core::NodeOrder::vtk);
        const auto tet = core::nodes_of_degree(tetrahedron, p, core::NodeOrder::vtk);
        const int along[4] = {degree, degree, degree, static_cast<int>(prism.size())};
        for (std::size_t i = 0; i < hex.size(); ++i)
            ASSERT_EQ(vtkHigherOrderHexahedron::PointIndexFromIJK(hex[i][0], hex[i][1], hex[i][2], along),
                      static_cast<int>(i));
        for (std::size_t i = 0; i < prism.size(); ++i)
            ASSERT_EQ(vtkHigherOrderWedge::PointIndexFromIJK(prism[i][0], prism[i][1], prism[i][2], along),
                      static_cast<int>(i));
        for (std::size_t i = 0; i < tet.size(); ++i) {
            vtkIdType weights[4] = {};
            vtkHigherOrderTetra::BarycentricIndex(static_cast<vtkIdType>(i), weights, degree);
            for (std::size_t k = 0; k < 3; ++k) ASSERT_EQ(weights[k], tet[i][k]) << degree << " " << i;
        }
    }
}

} // namespace
} // namespace isotet::test
