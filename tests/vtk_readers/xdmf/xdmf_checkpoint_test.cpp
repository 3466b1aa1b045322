// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Finite element functions, as DOLFIN's write_checkpoint() writes them.
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "support/temporary_folder.hpp"
#include "vtk_readers/xdmf/xdmf_text.hpp"

namespace isotet::test {
namespace {

/// A function on two tets.
struct Function {
    std::string family, degree, numbers, values, begins;
    std::string cell = "tetrahedron";
};

std::string text_of(const Function& f) {
    return "<Attribute ItemType='FiniteElementFunction' ElementFamily='" + f.family + "' ElementDegree='" + f.degree +
           "' ElementCell='" + f.cell + "' Name='f' Center='Other' AttributeType='Scalar'>" +
           xdmf_item("NumberType='UInt'", f.numbers) + xdmf_item("Precision='8'", f.values) +
           xdmf_item("NumberType='UInt'", f.begins) + xdmf_item("NumberType='UInt'", "1 0") + "</Attribute>";
}

class ReadCheckpoint : public testing::Test {
protected:
    Result<ReadResult> read_function(const Function& function, const std::string& mesh = xdmf_points() + xdmf_tets()) {
        ReadOptions options;
        (function.degree == "0" ? options.cell_fields : options.point_fields) = {"f"};
        return read(folder_.write("grid.xdmf", xdmf_document(xdmf_grid("g", mesh + text_of(function)))), options);
    }
    std::string error_of(const Function& function) {
        const auto result = read_function(function);
        return result ? "read" : result.error().message;
    }
    static std::vector<double> first(const std::vector<Field>& fields) {
        std::vector<double> values;
        for (std::size_t i = 0; !fields.empty() && i < fields[0].values.size(); ++i)
            values.push_back(fields[0].values.at(i / fields[0].values.components(), i % fields[0].values.components()));
        return values;
    }
    TemporaryFolder folder_;
};

using Values = std::vector<double>;

TEST_F(ReadCheckpoint, DegreeZeroIsAFieldOfCells) {
    const auto result = read_function({"DG", "0", "1 0", "5 6", "0 1 2"});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(first(result->grid.cell_fields), (Values{6, 5}));
    EXPECT_TRUE(result->notes.empty());
    const auto vectors = read_function({"DG", "0", "0 1 2 3 4 5", "1 2 3 4 5 6", "0 3 6"});
    ASSERT_TRUE(vectors) << vectors.error().message;
    EXPECT_EQ(vectors->grid.cell_fields.at(0).values.components(), 3u);
    EXPECT_EQ(first(vectors->grid.cell_fields), (Values{1, 2, 3, 4, 5, 6}));
}

TEST_F(ReadCheckpoint, DegreeOneIsAFieldOfPoints) {
    const auto result = read_function({"CG", "1", "4 3 2 1 4 2 3 0", "50 20 30 40 10", "0 4 8"});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(first(result->grid.point_fields), (Values{10, 40, 30, 20, 50}));
    EXPECT_TRUE(result->notes.empty());
    // two components: in each cell first those of one
    const auto vectors =
        read_function({"CG", "1", "0 1 2 3 5 6 7 8  0 2 1 4 5 7 6 9", "1 2 3 4 5 10 20 30 40 50", "0 8 16"});
    ASSERT_TRUE(vectors) << vectors.error().message;
    EXPECT_EQ(first(vectors->grid.point_fields), (Values{1, 10, 2, 20, 3, 30, 4, 40, 5, 50}));
}

TEST_F(ReadCheckpoint, FamiliesHaveSeveralNames) {
    for (const char* family : {"CG", "lagrange", "P", "p", "Q", "DG", "Discontinuous Lagrange", "dp", "DQ"}) {
        const auto result = read_function({family, "1", "4 3 2 1 4 2 3 0", "50 20 30 40 10", "0 4 8"});
        ASSERT_TRUE(result) << family << ": " << result.error().message;
        EXPECT_EQ(first(result->grid.point_fields), (Values{10, 40, 30, 20, 50})) << family;
    }
}

TEST_F(ReadCheckpoint, DiscontinuousFunctionsHaveMeansWhereTheyJump) {
    const auto continuous = read_function({"DG", "1", "0 1 2 3 4 5 6 7", "1 2 3 4 1 3 2 5", "0 4 8"});
    ASSERT_TRUE(continuous) << continuous.error().message;
    EXPECT_EQ(first(continuous->grid.point_fields), (Values{1, 2, 3, 4, 5}));
    EXPECT_TRUE(continuous->notes.empty());
    const auto jumps = read_function({"DG", "1", "0 1 2 3 4 5 6 7", "1 2 3 4 2 3 2 5", "0 4 8"});
    ASSERT_TRUE(jumps) << jumps.error().message;
    EXPECT_EQ(first(jumps->grid.point_fields), (Values{1.5, 2, 3, 4, 5}));
    EXPECT_EQ(jumps->notes,
              std::vector<std::string>{"function \"f\" differs between cells at 1 points: the mean was taken"});
}

/// Values of DOLFIN's nodes of a cell: the corners, then the edges, by the corners that they do not touch.
TEST_F(ReadCheckpoint, DegreeTwoMakesTetrahedraOfTenNodes) {
    const std::string mesh = "<Geometry>" + xdmf_item("Dimensions='4 3'", "0 0 0 2 0 0 0 2 0 0 0 2") +
                             "</Geometry><Topology TopologyType='Tetrahedron'>" +
                             xdmf_item("NumberType='Int'", "0 1 2 3") +
                             "</Topology><Attribute Name='linear' Center='Node'>" +
                             xdmf_item("NumberType='Int'", "0 2 4 7") + "</Attribute>";
    // f = 1 + x + 10 y^2 + 100 z at corners and middles of (2,3), (1,3), (1,2), (0,3), (0,2), (0,1)
    const Function f{"CG", "2", "0 1 2 3 4 5 6 7 8 9", "1 3 41 201 111 102 12 101 11 2", "0 10"};
    ReadOptions options;
    options.point_fields = {"f", "linear"};
    const auto result = read(folder_.write("grid.xdmf", xdmf_document(xdmf_grid("g", mesh + text_of(f)))), options);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_TRUE(result->notes.empty());
    const Grid& grid = result->grid;
    EXPECT_EQ(grid.cells.types.at(0), 24);
    ASSERT_EQ(grid.points.tuples(), 10u);
    ASSERT_EQ(grid.point_fields.size(), 2u);
    for (std::size_t node = 0; node < 10; ++node) {
        const auto point = static_cast<std::size_t>(grid.cells.connectivity.at(node));
        const auto at = [&](std::size_t axis) { return grid.points.at(point, axis); };
        EXPECT_EQ(grid.point_fields[1].values.at(point), 1 + at(0) + 10 * at(1) * at(1) + 100 * at(2)) << node;
        EXPECT_EQ(grid.point_fields[0].values.at(point), at(0) + 2 * at(1) + 3.5 * at(2)) << node;
    }
    options.point_fields = {"linear"};
    const auto unwanted = read(folder_.file("grid.xdmf"), options);
    ASSERT_TRUE(unwanted) << unwanted.error().message;
    EXPECT_EQ(unwanted->grid.points.tuples(), 4u) << "without the function the cells stay as they are";
}

TEST_F(ReadCheckpoint, OfDegreeTwoCellsShareTheNodesOfTheirEdges) {
    const auto result = read_function(
        {"CG", "2", "0 1 2 3 5 6 7 8 9 10  0 2 1 4 11 12 7 13 10 9", "1 2 3 4 5 6 7 8 9 10 11 12 13 14", "0 10 20"});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.points.tuples(), 5u + 9u);
    EXPECT_TRUE(result->notes.empty()) << result->notes.front();
    const auto jumps = read_function({"DG", "2", "0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19",
                                      "1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 3 1 1 1", "0 10 20"});
    ASSERT_TRUE(jumps) << jumps.error().message;
    EXPECT_EQ(jumps->notes,
              std::vector<std::string>{"function \"f\" differs between cells at 1 points: the mean was taken"});
}

/// Corners of a hexahedron are in VTK's order, values in that of a tensor product.
TEST_F(ReadCheckpoint, ReadsHexahedra) {
    const std::string mesh = "<Geometry>" +
                             xdmf_item("Dimensions='8 3'", "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1") +
                             "</Geometry><Topology TopologyType='Hexahedron'>" +
                             xdmf_item("NumberType='Int'", "0 1 2 3 4 5 6 7") + "</Topology>";
    const auto result =
        read_function({"CG", "1", "0 1 2 3 4 5 6 7", "0 1 10 11 100 101 110 111", "0 8", "hexahedron"}, mesh);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(first(result->grid.point_fields), (Values{0, 1, 11, 10, 100, 101, 111, 110}));
}

TEST_F(ReadCheckpoint, WhatIsNotReadIsSaid) {
    EXPECT_NE(error_of({"N1curl", "1", "0 1", "1 2", "0 1 2"}).find("family \"N1curl\""), std::string::npos);
    EXPECT_NE(error_of({"CG", "3", "0 1", "1 2", "0 1 2"}).find("degree 3"), std::string::npos);
    EXPECT_NE(error_of({"CG", "1", "0 1 2", "1 2", "0 1 2"}).find("no multiple of 4"), std::string::npos);
    EXPECT_NE(error_of({"DG", "0", "0 7", "1 2", "0 1 2"}).find("has value 7, but there are 2"), std::string::npos);
    EXPECT_NE(error_of({"DG", "0", "0 1", "1 2", "0 2 2"}).find("different numbers of values"), std::string::npos);
    EXPECT_NE(error_of({"CG", "1", "0 1 2 3 4 5 6 7 0 1 2 3 4 5 6 7", "0 1 2 3 4 5 6 7", "0 8 16", "hexahedron"})
                  .find("of hexahedron cells"),
              std::string::npos);
    const auto result = read(folder_.write(
        "grid.xdmf",
        xdmf_document(xdmf_grid("g", xdmf_points() + xdmf_tets() + text_of({"RT", "1", "0 1", "1 2", "0 1 2"})))));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.left_out.size(), 1u);
}

} // namespace
} // namespace isotet::test
