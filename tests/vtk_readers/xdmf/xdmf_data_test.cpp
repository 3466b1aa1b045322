// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What DataItems, geometries and topologies of XDMF may be.
#include <gtest/gtest.h>

#include <isotet/make.hpp>
#include <isotet/read.hpp>

#include "support/temporary_folder.hpp"
#include "vtk_readers/hdf5_writer.hpp"
#include "vtk_readers/xdmf/xdmf_text.hpp"

namespace isotet::test {
namespace {

std::vector<double> values_in(const Array& array) {
    std::vector<double> out;
    for (std::size_t i = 0; i < array.tuples(); ++i)
        for (std::size_t c = 0; c < array.components(); ++c) out.push_back(array.at(i, c));
    return out;
}

class ReadXdmfData : public testing::Test {
protected:
    ReadXdmfData() {
        Hdf5Writer file(folder_.file("heavy.h5"));
        std::vector<double> steps;
        for (int i = 0; i < 40; ++i) steps.push_back(i);
        file.data<double>("/steps", steps, {4, 10});
        file.data<double>("/a|b", {5, 4, 3, 2, 1}, {5});
        file.data<std::int32_t>("/cells", {0, 1, 2, 3, 0, 2, 1, 4}, {8});
        file.stored<double>("/whole", {1, 2, 3, 4, 5}, {5}, {.chunk = {2}, .never_filled = true});
        file.stored<double>("/begun", {1, 2, 3, 4, 5}, {5}, {.chunk = {2}, .unwritten = 3, .never_filled = true});
        file.stored<double>("/none", {1, 2, 3, 4, 5}, {5}, {.unwritten = 5, .never_filled = true});
        file.stored<double>("/filled", {1, 2, 3, 4, 5}, {5}, {.chunk = {2}, .unwritten = 3});
    }
    Result<ReadResult> read_grid(const std::string& content, const ReadOptions& options = {}) {
        return read(folder_.write("grid.xdmf", xdmf_document(xdmf_grid("g", content))), options);
    }
    /// A field p of the two tets, that is a DataItem.
    Result<ReadResult> read_item(const std::string& item) {
        ReadOptions options;
        options.point_fields = {"p"};
        return read_grid(xdmf_points() + xdmf_tets() + "<Attribute Name='p'>" + item + "</Attribute>", options);
    }
    std::vector<double> values_of(const std::string& item) {
        const auto result = read_item(item);
        if (!result) ADD_FAILURE() << item << ": " << result.error().message;
        return result ? values_in(result->grid.point_fields.at(0).values) : std::vector<double>();
    }
    std::string error_of(const std::string& item) {
        const auto result = read_item(item);
        return result ? "read" : result.error().message;
    }
    std::string mesh_error(const std::string& content) {
        const auto result = read_grid(content);
        return result ? "read" : result.error().message;
    }
    TemporaryFolder folder_;
};

std::string heavy(const std::string& text) { return xdmf_item("Format='HDF' Dimensions='5'", text); }
std::string numbers(const std::string& values, const std::string& dimensions = "") {
    return xdmf_item(
        "NumberType='Float' Precision='8'" + (dimensions.empty() ? "" : " Dimensions='" + dimensions + "'"), values);
}
std::string function(const std::string& expression, const std::string& items) {
    return "<DataItem ItemType='Function' Function='" + expression + "'>" + items + "</DataItem>";
}
std::string slab(const std::string& box, const std::string& source) {
    return "<DataItem ItemType='HyperSlab'>" + numbers(box) + source + "</DataItem>";
}

using Values = std::vector<double>;

TEST_F(ReadXdmfData, TakesPartsOfDataSetsBehindABar) {
    EXPECT_EQ(values_of(heavy("heavy.h5:/steps|2 0:1 1:1 5:4 10")), (Values{20, 21, 22, 23, 24}));
    EXPECT_EQ(values_of(heavy("heavy.h5:/steps|1 1:1 2:1 5:4 10")), (Values{11, 13, 15, 17, 19}));
    EXPECT_EQ(values_of(heavy("heavy.h5:/steps | 0 7 : 1 1 : 1 3 : 4 10 | heavy.h5:/steps|3 0:1 1:1 2:4 10")),
              (Values{7, 8, 9, 30, 31}));
    EXPECT_EQ(values_of(heavy("heavy.h5:/a|b")), (Values{5, 4, 3, 2, 1})) << "a bar in a name";
    EXPECT_NE(error_of(heavy("heavy.h5:/steps|3 6:1 1:1 5:4 10")).find("the part that is wanted"), std::string::npos);
    EXPECT_NE(error_of(heavy("heavy.h5:/steps|3:1:5:40")).find("the part that is wanted"), std::string::npos);
    EXPECT_NE(error_of(heavy("heavy.h5:/steps|0 0:1 1:1 4:4 10")).find("has 4 values, but 5"), std::string::npos);
    EXPECT_NE(error_of(heavy("heavy.h5:/steps|0 0:1 0:1 5:4 10")).find("the part that is wanted"), std::string::npos);
    EXPECT_NE(error_of(heavy("heavy.h5:/steps|0 0:1 1:1 18446744073709551615:4 10")).find("the part"),
              std::string::npos);
}

TEST_F(ReadXdmfData, TakesSlabsAndPlacesOfAnything) {
    const std::string table = numbers("0 1 2 3 4 5 6 7 8 9 10 11", "2 6");
    EXPECT_EQ(values_of(slab("1 0 1 1 1 5", table)), (Values{6, 7, 8, 9, 10}));
    EXPECT_EQ(values_of(slab("2 1 1 2 1 5", xdmf_item("Format='HDF' Dimensions='4 10'", "heavy.h5:/steps"))),
              (Values{21, 23, 25, 27, 29}));
    EXPECT_EQ(values_of(slab("20 2 5", xdmf_item("Format='HDF' Dimensions='40'", "heavy.h5:/steps"))),
              (Values{20, 22, 24, 26, 28}))
        << "the dimensions that are stated";
    EXPECT_EQ(values_of("<DataItem ItemType='Coordinates'>" + numbers("0 5 1 0 1 1 0 0 1 5") + table + "</DataItem>"),
              (Values{5, 6, 7, 0, 11}));
    EXPECT_NE(error_of(slab("1 2 1 1 1 5", table)).find("does not lie within"), std::string::npos);
    EXPECT_NE(error_of(slab("1 0 1 1 1", table)).find("without start"), std::string::npos);
    EXPECT_NE(error_of(slab("1 0.5 1 1 1 5", table)).find("0.5 is not a whole number"), std::string::npos);
    EXPECT_NE(error_of("<DataItem ItemType='Coordinates'>" + numbers("2 0") + table + "</DataItem>").find("place 2"),
              std::string::npos);
}

TEST_F(ReadXdmfData, TakesOtherSpellings) {
    for (const char* format : {"HDF", "hdf", "HDF5", "hdf5"}) {
        const std::string data = "Dimensions='4 10' Format='" + std::string(format) + "'";
        EXPECT_EQ(values_of(slab("2 1 1 2 1 5", xdmf_item(data, "heavy.h5:/steps"))), (Values{21, 23, 25, 27, 29}));
        EXPECT_EQ(values_of(xdmf_item("Dimensions='5' Format='" + std::string(format) + "'", "heavy.h5:/a|b")),
                  (Values{5, 4, 3, 2, 1}));
    }
    EXPECT_EQ(values_of("<DataItem ItemType='Coordinate'>" + numbers("4 3 2 1 0") + numbers("0 1 2 3 4", "5") +
                        "</DataItem>"),
              (Values{4, 3, 2, 1, 0}));
}

TEST_F(ReadXdmfData, EvaluatesFunctions) {
    const std::string p = numbers("1 2 3 4 5"), q = numbers("10 20 30 40 50");
    EXPECT_EQ(values_of(function("$0 + $1", p + q)), (Values{11, 22, 33, 44, 55}));
    EXPECT_EQ(values_of(function("2*($1 - $0) / -3", p + q)), (Values{-6, -12, -18, -24, -30}));
    EXPECT_EQ(values_of(function("SQRT($0 * $0) + abs(-1e0)", p)), (Values{2, 3, 4, 5, 6}));
    EXPECT_EQ(values_of(function("JOIN($0, $1, 2*$0)", p + q)),
              (Values{1, 10, 2, 2, 20, 4, 3, 30, 6, 4, 40, 8, 5, 50, 10}));
    EXPECT_EQ(values_of(function("JOIN($0 ; $1)", numbers("1 2") + numbers("3 4 5"))), (Values{1, 2, 3, 4, 5}));
    EXPECT_EQ(values_of(function("$0", function("$0 + 1", p))), (Values{2, 3, 4, 5, 6}));
    for (const char* wrong :
         {"", "$0 +", "$2", "$", "POW($0, 2)", "JOIN($0", "$0 $1", "$0 + $1 ; $0", "1 2", "JOIN($0, 1)"})
        EXPECT_NE(error_of(function(wrong, p + q)).find("the function"), std::string::npos) << wrong;
    EXPECT_NE(error_of(function("$0 + $1", p + numbers("1 2"))).find("5 and 2 values"), std::string::npos);
    EXPECT_NE(error_of(function(std::string(1000, '('), p)).find("without end"), std::string::npos);
    std::string nested = p;
    for (int i = 0; i < 30; ++i) nested = function("$0", nested);
    EXPECT_NE(error_of(nested).find("nested"), std::string::npos);
}

TEST_F(ReadXdmfData, KnowsTypesAndTheirDefaults) {
    const auto type = [&](const std::string& attributes) {
        const auto result = read_item(xdmf_item(attributes, "1 2 3 4 5"));
        return result ? std::string(name_of(result->grid.point_fields.at(0).values.type())) : result.error().message;
    };
    EXPECT_EQ(type(""), "float32");
    EXPECT_EQ(type("NumberType='Float' Precision='8'"), "float64");
    EXPECT_EQ(type("DataType='Double'"), "float64");
    EXPECT_EQ(type("NumberType='int'"), "int32");
    EXPECT_EQ(type("NumberType='UInt' Precision='8'"), "uint64");
    EXPECT_EQ(type("NumberType='UChar'"), "uint8");
    EXPECT_EQ(type("NumberType='Char'"), "int8");
    EXPECT_EQ(type("NumberType='Short'"), "int16");
    EXPECT_EQ(type("NumberType='UShort' Dimensions='5 1'"), "uint16");
    EXPECT_EQ(type("NumberType='Long'"), "int64");
    EXPECT_NE(type("NumberType='Float' Precision='2'").find("is not read"), std::string::npos);
    EXPECT_NE(error_of(xdmf_item("NumberType='UChar'", "1 2 3 4 256")).find("at place 4"), std::string::npos);
    EXPECT_NE(error_of(xdmf_item("NumberType='UInt'", "1 2 3 4 -5")).find("at place 4"), std::string::npos);
    EXPECT_EQ(values_of(xdmf_item("Dimensions='5'", "1 2 <!-- three --> 3 <![CDATA[4]]> 5")), (Values{1, 2, 3, 4, 5}));
    folder_.write("p.bin", std::string("\0\1\0\2\0\3\0\4\0\5", 10));
    EXPECT_EQ(values_of(xdmf_item("Format='Binary' NumberType='Short' Endian='Big' Dimensions='5'", "p.bin")),
              (Values{1, 2, 3, 4, 5}));
    EXPECT_NE(error_of(xdmf_item("Format='Binary' Compression='Zlib' Dimensions='5'", "p.bin")).find("compression"),
              std::string::npos);
    EXPECT_NE(error_of(xdmf_item("Format='TIFF' Dimensions='5'", "p.tif")).find("format \"TIFF\""), std::string::npos);
}

/// A value that HDF5 does not give is never what memory held.
TEST_F(ReadXdmfData, RefusesValuesThatWereNeverWritten) {
    EXPECT_EQ(values_of(heavy("heavy.h5:/whole")), (Values{1, 2, 3, 4, 5}));
    EXPECT_EQ(values_of(heavy("heavy.h5:/filled")), (Values{1, 2, 0, 0, 0})) << "HDF5's value for them";
    EXPECT_NE(error_of(heavy("heavy.h5:/begun")).find("never written"), std::string::npos);
    EXPECT_NE(error_of(heavy("heavy.h5:/none")).find("never written"), std::string::npos);
}

TEST_F(ReadXdmfData, ReadsCoordinatesApart) {
    const std::string apart = "<Geometry GeometryType='X_Y_Z'>" + numbers("0 1 0 0 0") + numbers("0 0 1 0 0") +
                              xdmf_item("NumberType='Int'", "0 0 0 1 -1") + "</Geometry>";
    const auto result = read_grid(apart + xdmf_tets());
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(values_in(result->grid.points), values_in(read_grid(xdmf_points() + xdmf_tets()).value().grid.points));
    EXPECT_NE(mesh_error("<Geometry GeometryType='X_Y_Z'>" + numbers("0 1") + numbers("0 0 1") + numbers("0 0") +
                         "</Geometry>" + xdmf_tets())
                  .find("2 and 3 coordinates"),
              std::string::npos);
    EXPECT_NE(mesh_error("<Geometry GeometryType='X_Y_Z'>" + numbers("0 1") + "</Geometry>" + xdmf_tets())
                  .find("1 DataItems, but needs 3"),
              std::string::npos);
}

TEST_F(ReadXdmfData, ReadsPlanesAsQuadrilaterals) {
    const auto plane =
        read_grid("<Topology TopologyType='3DCoRectMesh' Dimensions='3 1 4'/><Geometry "
                  "GeometryType='ORIGIN_DXDYDZ'>" +
                  numbers("0 0 3") + numbers("5 1 4") + "</Geometry>" + xdmf_field("c", "1 2 3 4 5 6", "Cell"));
    ASSERT_TRUE(plane) << plane.error().message;
    ASSERT_EQ(plane->grid.cells.count(), 6u);
    EXPECT_EQ(plane->grid.cells.types.at(5), 9);
    EXPECT_EQ(plane->grid.cell_fields.at(0).values.at(5), 6);
}

/// Axes are stated slowest first; the points of all three ways are the same.
TEST_F(ReadXdmfData, ReadsStructuredGridsAsHexahedra) {
    const std::string sizes = " Dimensions='2 3 4'/>", of_cells = xdmf_field("c", "1 2 3 4 5 6", "Cell");
    std::string coordinates;
    for (const char* z : {"0", "5"})
        for (const char* y : {"0", "1", "2"})
            for (const char* x : {"3", "7", "11", "15"}) coordinates += std::string(x) + " " + y + " " + z + " ";
    const auto curved = read_grid("<Topology TopologyType='3DSMesh'" + sizes + "<Geometry>" +
                                  xdmf_item("Precision='8'", coordinates) + "</Geometry>" + of_cells);
    const auto axes = read_grid("<Topology TopologyType='3DRectMesh'" + sizes + "<Geometry GeometryType='VXVYVZ'>" +
                                numbers("3 7 11 15") + numbers("0 1 2") + numbers("0 5") + "</Geometry>" + of_cells);
    const auto image = read_grid("<Topology TopologyType='3DCORECTMesh' NumberOfElements='2 3 4'/><Geometry "
                                 "GeometryType='ORIGIN_DXDYDZ'>" +
                                 numbers("0 0 3") + numbers("5 1 4") + "</Geometry>" + of_cells);
    for (const auto* result : {&curved, &axes, &image}) {
        ASSERT_TRUE(*result) << result->error().message;
        EXPECT_EQ((*result)->grid.cells.count(), 6u);
        EXPECT_EQ((*result)->grid.cells.uniform_type, CellType::hexahedron);
        EXPECT_EQ(values_in((*result)->grid.points), values_in(curved->grid.points));
        EXPECT_EQ((*result)->grid.cell_fields.at(0).values.at(5), 6);
    }
    EXPECT_NE(mesh_error("<Topology TopologyType='3DSMesh' Dimensions='2 3 5'/><Geometry>" + numbers(coordinates) +
                         "</Geometry>")
                  .find("5 x 3 x 2 points has 24"),
              std::string::npos);
    EXPECT_NE(mesh_error("<Topology TopologyType='3DSMesh' Dimensions='2 3'/><Geometry>" + numbers(coordinates) +
                         "</Geometry>")
                  .find("no three numbers"),
              std::string::npos);
    EXPECT_NE(mesh_error("<Topology TopologyType='3DCoRectMesh' Dimensions='1000000 1000000 1000000'/><Geometry "
                         "GeometryType='ORIGIN_DXDYDZ'>" +
                         numbers("0 0 3") + numbers("5 1 4") + "</Geometry>"),
              "read");
    EXPECT_NE(mesh_error(xdmf_tets() + "<Geometry GeometryType='VXVYVZ'>" + numbers("3") + "</Geometry>")
                  .find("geometry of type \"VXVYVZ\" with a topology of type \"Tetrahedron\""),
              std::string::npos);
    EXPECT_NE(mesh_error("<Topology TopologyType='2DSMesh' Dimensions='3 4'/>" + xdmf_points()).find("2DSMesh"),
              std::string::npos);
}

std::string topology(const std::string& attributes, const std::string& values) {
    return "<Topology " + attributes + ">" + xdmf_item("NumberType='Int'", values) + "</Topology>";
}

TEST_F(ReadXdmfData, ReadsPolyhedra) {
    const std::string tetrahedron = "4 3 0 1 2 3 0 1 3 3 1 2 3 3 0 2 3 ";
    for (const std::string& cells :
         {topology("TopologyType='Mixed' NumberOfElements='2'", "16 " + tetrahedron + " 6 0 2 1 4"),
          topology("TopologyType='Mixed'", "16 " + tetrahedron + " 6 0 2 1 4")}) {
        const auto result = read_grid(xdmf_points() + cells);
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(values_in(result->grid.cells.types), (Values{42, 10}));
        EXPECT_EQ(values_in(result->grid.cells.connectivity), (Values{0, 1, 2, 3, 0, 2, 1, 4}));
        EXPECT_EQ(result->grid.cells.faces.size(), 17u);
    }
    for (const std::string& numbers : {tetrahedron, "16 " + tetrahedron}) {
        const auto result =
            read_grid(xdmf_points() + topology("TopologyType='Polyhedron' NumberOfElements='1'", numbers));
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->grid.cells.count(), 1u);
        EXPECT_EQ(result->grid.cells.faces.size(), 17u);
    }
    for (const char* broken : {"16", "16 4", "16 4 3 0 1", "16 -1", "16 9999999999 3", "16 1 -3", "16 1 3 0 1 9",
                               "16 1 3 0 1 2 6", "77 1 2"})
        EXPECT_NE(mesh_error(xdmf_points() + topology("TopologyType='Mixed' NumberOfElements='1'", broken)), "read")
            << broken;
    EXPECT_NE(mesh_error(xdmf_points() + topology("TopologyType='Mixed'", "77 1 2")).find("type 77"),
              std::string::npos);
}

TEST_F(ReadXdmfData, FollowsBaseOffsetAndOrder) {
    const auto cells = [&](const std::string& attributes, const std::string& values) {
        const auto result = read_grid(xdmf_points() + topology("TopologyType='Tetrahedron' " + attributes, values));
        if (!result) ADD_FAILURE() << result.error().message;
        return result ? values_in(result->grid.cells.connectivity) : Values();
    };
    EXPECT_EQ(cells("BaseOffset='1'", "1 2 3 4 1 3 2 5"), (Values{0, 1, 2, 3, 0, 2, 1, 4}));
    EXPECT_EQ(cells("Order='0 2 3 1'", "0 1 2 3 4 2 1 0"), (Values{0, 2, 3, 1, 4, 1, 0, 2})) << "as VTK 9.7 does";
    const auto error = [&](const std::string& attributes) {
        return mesh_error(xdmf_points() + topology("TopologyType='Tetrahedron' " + attributes, "0 1 2 3 0 2 1 4"));
    };
    EXPECT_NE(error("BaseOffset='1'").find("point -1"), std::string::npos) << error("BaseOffset='1'");
    EXPECT_NE(error("Order='0 1 2'").find("Order"), std::string::npos);
    EXPECT_NE(error("Order='0 1 2 4'").find("Order"), std::string::npos);
    EXPECT_NE(error("NumberOfElements='3'").find("3 elements are stated, 2 are there"), std::string::npos);
    EXPECT_NE(error("NumberOfElements='3 2 1'").find("6 elements are stated, 2 are there"), std::string::npos);
    for (const std::string counts : {"2 1 1", "2 4"})
        EXPECT_EQ(cells("NumberOfElements='" + counts + "'", "0 1 2 3 0 2 1 4"), (Values{0, 1, 2, 3, 0, 2, 1, 4}));
}

/// As h5py cuts what it compresses.
TEST_F(ReadXdmfData, TakesCornersOfManyChunksAsInt32) {
    const Grid made = make_grid({.shape = "kuhn", .side = 48, .fields = {}}).value();
    std::vector<double> points;
    for (std::size_t i = 0; i < made.points.size(); ++i) points.push_back(made.points.at(i / 3, i % 3));
    std::vector<std::int64_t> corners;
    for (std::size_t i = 0; i < made.cells.connectivity.size(); ++i)
        corners.push_back(static_cast<std::int64_t>(made.cells.connectivity.at(i)));
    {
        Hdf5Writer file(folder_.file("large.h5"));
        file.stored<double>("/points", points, {points.size() / 3, 3}, {.chunk = {4000, 1}, .deflated = true});
        file.stored<std::int64_t>("/cells", corners, {corners.size() / 4, 4}, {.chunk = {12000, 1}, .deflated = true});
    }
    const auto result = read_grid("<Geometry GeometryType='XYZ'>" + xdmf_item("Format='HDF'", "large.h5:/points") +
                                  "</Geometry>" + "<Topology TopologyType='Tetrahedron'>" +
                                  xdmf_item("Format='HDF'", "large.h5:/cells") + "</Topology>");
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(values_in(result->grid.points), points);
    EXPECT_EQ(result->grid.cells.connectivity.type(), ScalarType::int32);
    EXPECT_EQ(values_in(result->grid.cells.connectivity), Values(corners.begin(), corners.end()));
}

} // namespace
} // namespace isotet::test
