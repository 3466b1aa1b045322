// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// XDMF with values in XML, HDF5 and binary files.
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "vtk_readers/hdf5_writer.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

std::string document(const std::string& domain, const std::string& doctype = {}) {
    return "<?xml version=\"1.0\"?>\n" + doctype + "<Xdmf Version=\"3.0\"><Domain>" + domain + "</Domain></Xdmf>\n";
}

const std::string points = "<Geometry GeometryType=\"XYZ\"><DataItem Format=\"XML\" Dimensions=\"5 3\" Precision=\"8\">"
                           "0 0 0  1 0 0  0 1 0  0 0 1  0 0 -1</DataItem></Geometry>";
const std::string tets =
    "<Topology TopologyType=\"Tetrahedron\" NumberOfElements=\"2\"><DataItem Format=\"XML\" NumberType=\"Int\" "
    "Dimensions=\"2 4\">0 1 2 3  0 2 1 4</DataItem></Topology>";

std::string field(const std::string& name, const std::string& values,
                  const std::string& attributes = "AttributeType=\"Scalar\" Center=\"Node\"",
                  const std::string& dimensions = "5") {
    return "<Attribute Name=\"" + name + "\" " + attributes + "><DataItem Format=\"XML\" Dimensions=\"" + dimensions +
           "\">" + values + "</DataItem></Attribute>";
}
std::string grid(const std::string& content) { return "<Grid Name=\"g\" GridType=\"Uniform\">" + content + "</Grid>"; }

class ReadXdmf : public testing::Test {
protected:
    Result<ReadResult> read_domain(const std::string& domain, const ReadOptions& options = {},
                                   const std::string& doctype = {}) {
        return read(folder_.write("grid.xdmf", document(domain, doctype)), options);
    }
    /// Of a grid whose field p is asked for, if it has one.
    std::string error_of(const std::string& domain) {
        ReadOptions options;
        if (domain.find("<Attribute Name=\"p\"") != std::string::npos) options.point_fields = {"p"};
        const auto result = read_domain(domain, options);
        return result ? "read" : result.error().message;
    }
    TemporaryFolder folder_;
};

TEST_F(ReadXdmf, ReadsValuesInXml) {
    const auto result = read_domain(grid(points + tets + field("p", "1 2 3 4 5e-3") +
                                         field("v", "1 2 3 4 5 6", "AttributeType=\"Vector\" Center=\"Cell\"", "2 3")));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.points.tuples(), 5u);
    EXPECT_EQ(result->grid.points.at(4, 2), -1);
    EXPECT_EQ(result->grid.cells.count(), 2u);
    EXPECT_EQ(result->grid.point_fields.at(0).values.at(4), static_cast<double>(5e-3f));
    EXPECT_EQ(result->grid.cell_fields.at(0).values.components(), 3u);
    EXPECT_EQ(result->grid.cell_fields.at(0).values.at(1, 2), 6);
}

TEST_F(ReadXdmf, SymmetricTensorsHaveVtksOrder) {
    const std::string rows = "11 12 13 22 23 33 ";
    const auto result = read_domain(
        grid(points + tets +
             field("p", rows + rows + rows + rows + rows, "AttributeType=\"Tensor6\" Center=\"Node\"", "5 6") +
             field("c", rows + rows, "AttributeType=\"tensor6\" Center=\"Cell\"", "2 6") +
             field("m", rows + rows, "AttributeType=\"Matrix\" Center=\"Cell\"", "2 6")));
    ASSERT_TRUE(result) << result.error().message;
    const auto tuple_of = [](const Field& field, std::size_t tuple) {
        std::vector<double> values;
        for (std::size_t c = 0; c < field.values.components(); ++c) values.push_back(field.values.at(tuple, c));
        return values;
    };
    const std::vector<double> as_vtk{11, 22, 33, 12, 23, 13};
    EXPECT_EQ(tuple_of(result->grid.point_fields.at(0), 4), as_vtk);
    EXPECT_EQ(tuple_of(result->grid.cell_fields.at(0), 1), as_vtk);
    EXPECT_EQ(tuple_of(result->grid.cell_fields.at(1), 1), (std::vector<double>{11, 12, 13, 22, 23, 33}));
}

TEST_F(ReadXdmf, ReadsHdf5WithHyperSlabsEntitiesAndReferences) {
    {
        Hdf5Writer file(folder_.file("heavy.h5"));
        file.group("/mesh");
        file.data<double>("/mesh/points", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1}, {5, 3});
        file.data<std::int64_t>("/mesh/cells", {0, 1, 2, 3, 0, 2, 1, 4}, {2, 4});
        file.data<float>("/steps", {1, 2, 3, 4, 5, 11, 12, 13, 14, 15}, {2, 5, 1});
    }
    const std::string domain =
        "<DataItem Name=\"cells\" Format=\"HDF\" Dimensions=\"2 4\">&Heavy;:/mesh/cells</DataItem>" +
        grid("<Geometry GeometryType=\"XYZ\"><DataItem Format=\"HDF\" Dimensions=\"5 3\"> heavy.h5:/mesh/points "
             "</DataItem></Geometry>"
             "<Topology TopologyType=\"Tetrahedron\"><DataItem Reference=\"XML\"> /Xdmf/Domain/DataItem[@Name='cells'] "
             "</DataItem></Topology>"
             "<Attribute Name=\"p\" Center=\"Node\"><DataItem ItemType=\"HyperSlab\" Dimensions=\"1 5 1\">"
             "<DataItem Format=\"XML\" Dimensions=\"3 3\">1 0 0  1 1 1  1 5 1</DataItem>"
             "<DataItem Format=\"HDF\" Dimensions=\"2 5 1\">&Heavy;:/steps</DataItem></DataItem></Attribute>");
    const auto result = read_domain(domain, {}, "<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" [<!ENTITY Heavy \"heavy.h5\">]>\n");
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.points.type(), ScalarType::float64);
    EXPECT_EQ(result->grid.cells.connectivity.type(), ScalarType::int32);
    EXPECT_EQ(result->grid.cells.connectivity.at(7), 4);
    const Array& values = result->grid.point_fields.at(0).values;
    EXPECT_EQ(values.type(), ScalarType::float32);
    EXPECT_EQ(values.tuples(), 5u);
    EXPECT_EQ(values.at(4), 15);
}

TEST_F(ReadXdmf, ReadsBinaryFilesFromAPlaceOnAndChecksTheirLength) {
    const std::vector<float> values = {99, 1, 2, 3, 4, 5};
    folder_.write("p.bin", {reinterpret_cast<const char*>(values.data()), 24});
    const auto with_dimensions = [](const std::string& seek) {
        return grid(points + tets + "<Attribute Name=\"p\" Center=\"Node\"><DataItem Format=\"Binary\" Seek=\"" + seek +
                    "\" Dimensions=\"5\">p.bin</DataItem></Attribute>");
    };
    const auto result = read_domain(with_dimensions("4"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.point_fields.at(0).values.at(4), 5);
    EXPECT_NE(error_of(with_dimensions("5")).find("24 bytes"), std::string::npos);
}

TEST_F(ReadXdmf, ReadsTemporalCollections) {
    std::string steps = "<Grid GridType=\"Collection\" CollectionType=\"Temporal\">";
    for (const char* time : {"0.5", "1.5"})
        steps += grid(points + tets + "<Time Value=\"" + std::string(time) + "\"/>" +
                      field("p", std::string(time) + " 2 3 4 5"));
    const std::string domain = steps + "</Grid>";
    ReadOptions options;
    options.step = 1;
    const auto result = read_domain(domain, options);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.times, (std::vector<double>{0.5, 1.5}));
    EXPECT_EQ(result->grid.point_fields.at(0).values.at(0), 1.5);
}

TEST_F(ReadXdmf, JoinsSpatialCollections) {
    std::string moved = points;
    moved.replace(moved.find("0 0 -1"), 6, "0 0 -2");
    const auto result = read_domain("<Grid GridType=\"Collection\" CollectionType=\"Spatial\">" + grid(points + tets) +
                                    grid(moved + tets) + "</Grid>");
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.points.tuples(), 6u);
    EXPECT_EQ(result->grid.cells.count(), 3u) << "the tet that both have counts once";
}

/// As VTK 9.7: type 33, with the nodes in the order of the file.
TEST_F(ReadXdmf, ReadsHexahedraOf24Nodes) {
    std::string coordinates, nodes;
    for (int i = 0; i < 24; ++i) {
        coordinates += std::to_string(i % 3) + " " + std::to_string(i / 3 % 3) + " " + std::to_string(i / 9) + " ";
        nodes += " " + std::to_string(i);
    }
    const std::string geometry = "<Geometry><DataItem Dimensions=\"24 3\">" + coordinates + "</DataItem></Geometry>";
    for (const auto& [name, code] : {std::pair("Hexahedron_24", ""), {"Hex_24", ""}, {"Mixed", "49"}}) {
        const auto result = read_domain(grid(geometry + "<Topology TopologyType=\"" + name +
                                             "\" NumberOfElements=\"1\"><DataItem NumberType=\"Int\">" + code + nodes +
                                             "</DataItem></Topology>"));
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->grid.cells.types.at(0), 33) << name;
        for (std::size_t i = 0; i < 24; ++i) EXPECT_EQ(result->grid.cells.connectivity.at(i), double(i)) << name;
    }
}

TEST_F(ReadXdmf, ReadsMixedTopologies) {
    const std::string mixed =
        "<Topology TopologyType=\"Mixed\" NumberOfElements=\"3\"><DataItem Format=\"XML\" NumberType=\"Int\" "
        "Dimensions=\"15\">6 0 1 2 3  3 3 0 1 2  6 0 2 1 4</DataItem></Topology>";
    const auto result = read_domain(grid(points + mixed));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.types.at(0), 10);
    EXPECT_EQ(result->grid.cells.types.at(1), 7);
    EXPECT_EQ(result->grid.cells.offsets.at(3), 11);
    std::string broken = mixed;
    broken.replace(broken.find("NumberOfElements=\"3\""), 20, "NumberOfElements=\"4\"");
    EXPECT_NE(error_of(grid(points + broken)).find("element 3 of a mixed topology"), std::string::npos);
}

TEST_F(ReadXdmf, RefusesWhatLiesOutside) {
    {
        Hdf5Writer file(folder_.file("linked.h5"));
        file.external_link("/p", "other.h5", "/p");
        Hdf5Writer other(folder_.file("other.h5"));
        other.data<float>("/p", {1, 2, 3, 4, 5}, {5});
    }
    const auto with = [](const std::string& name) {
        return grid(points + tets + "<Attribute Name=\"p\" Center=\"Node\"><DataItem Format=\"HDF\" Dimensions=\"5\">" +
                    name + "</DataItem></Attribute>");
    };
    EXPECT_EQ(error_of(with("other.h5:/p")), "read");
    EXPECT_NE(error_of(with("linked.h5:/p")).find("link to another file"), std::string::npos);
    EXPECT_NE(error_of(with("../other.h5:/p")).find("only files below"), std::string::npos);
    EXPECT_NE(error_of(with("/etc/passwd:/p")).find("only files below"), std::string::npos);
}

TEST_F(ReadXdmf, GridsThatReferToEachOtherWithoutEndAreAnError) {
    const std::string again = "<Grid Reference=\"/Xdmf/Domain/Grid\"/>";
    EXPECT_NE(error_of("<Grid GridType=\"Collection\">" + again + again + "</Grid>").find("nested"), std::string::npos);
    EXPECT_NE(error_of("<Grid Reference=\"/Xdmf/Domain/Grid\"/>").find("refers to nothing"), std::string::npos);
    EXPECT_NE(error_of("<Grid Reference=\"][\"/>").find("refers to nothing"), std::string::npos);
}

TEST_F(ReadXdmf, CountsThatDoNotFitAreErrors) {
    EXPECT_NE(error_of(grid(points + tets + field("p", "1 2 3 4"))), "read");
    EXPECT_NE(error_of(grid(points + tets + field("p", "1 2 3 4 5 6"))), "read");
    EXPECT_NE(error_of(grid(points + tets + field("p", "1 2 3 4", "Center=\"Node\"", "4"))), "read");
    EXPECT_NE(error_of(grid(points + tets + field("p", "1 2 3 4 x"))), "read");
    EXPECT_NE(error_of(grid(points + tets + field("p", "1 2 3 4 5", "Center=\"Node\"", "99999999999999999999"))),
              "read");
    EXPECT_NE(error_of(grid(points + tets + field("p", "1 2 3 4 5", "Center=\"Node\"", "4611686018427387904 4"))),
              "read");
    EXPECT_NE(error_of(grid(points)), "read");
    EXPECT_NE(error_of(""), "read");
}

} // namespace
} // namespace isotet::test
