// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTKHDF: partitions without cells, arrays that are too long, unreadable or never written.
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include <isotet/read.hpp>

#include "support/temporary_folder.hpp"
#include "vtk_readers/hdf5_writer.hpp"

namespace isotet::test {
namespace {

using Counts = std::vector<std::int64_t>;

/// Partitions of no or one tet, each on points of its own.
struct Parts {
    Counts cells;
    bool offsets_of_empty_parts = true;
    bool variable_type = false; ///< the text of Type has no fixed length
    std::int64_t points_of_empty_parts = 0;
};

void write_parts(Hdf5Writer& file, const Parts& parts) {
    for (const char* name : {"/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/CellData", "/VTKHDF/FieldData"}) file.group(name);
    file.attribute("/VTKHDF", "Version", Counts{2, 0});
    if (parts.variable_type) file.variable_attribute("/VTKHDF", "Type", "UnstructuredGrid");
    else file.attribute("/VTKHDF", "Type", "UnstructuredGrid");
    Counts points, corners, connectivity, offsets;
    std::vector<double> coordinates, values;
    std::vector<std::uint8_t> types;
    for (std::size_t part = 0; part < parts.cells.size(); ++part) {
        const bool empty = parts.cells[part] == 0;
        points.push_back(empty ? parts.points_of_empty_parts : 4);
        corners.push_back(empty ? 0 : 4);
        const auto x = static_cast<double>(10 * part);
        const double tet[] = {x, 0, 0, x + 1, 0, 0, x, 1, 0, x, 0, 1};
        coordinates.insert(coordinates.end(), tet, tet + 3 * points.back());
        for (std::int64_t i = 0; i < points.back(); ++i) values.push_back(x + static_cast<double>(i));
        if (!empty || parts.offsets_of_empty_parts) offsets.push_back(0);
        if (empty) continue;
        connectivity.insert(connectivity.end(), {0, 1, 2, 3});
        offsets.push_back(4);
        types.push_back(10);
    }
    file.data<std::int64_t>("/VTKHDF/NumberOfPoints", points, {points.size()});
    file.data<std::int64_t>("/VTKHDF/NumberOfCells", parts.cells, {points.size()});
    file.data<std::int64_t>("/VTKHDF/NumberOfConnectivityIds", corners, {points.size()});
    file.data<double>("/VTKHDF/Points", coordinates, {values.size(), 3});
    file.data<std::int64_t>("/VTKHDF/Connectivity", connectivity, {connectivity.size()});
    file.data<std::int64_t>("/VTKHDF/Offsets", offsets, {offsets.size()});
    file.data<std::uint8_t>("/VTKHDF/Types", types, {types.size()});
    file.data<double>("/VTKHDF/PointData/p", values, {values.size()});
    std::vector<double> of_cells;
    for (std::size_t i = 0; i < types.size(); ++i) of_cells.push_back(static_cast<double>(i));
    file.data<double>("/VTKHDF/CellData/c", of_cells, {of_cells.size()});
}

class ReadVtkhdfParts : public testing::Test {
protected:
    Result<ReadResult> read_parts(const Parts& parts) {
        {
            Hdf5Writer file(folder_.file("a.vtkhdf"));
            write_parts(file, parts);
        }
        return read(folder_.file("a.vtkhdf"));
    }
    /// Two tets, and something more.
    Result<ReadResult> read_with(const std::function<void(Hdf5Writer&)>& put, const ReadOptions& options = {}) {
        {
            Hdf5Writer file(folder_.file("a.vtkhdf"));
            write_two_tets(file);
            put(file);
        }
        return read(folder_.file("a.vtkhdf"), options);
    }
    TemporaryFolder folder_;
};

TEST_F(ReadVtkhdfParts, PartsWithoutCellsAddNothing) {
    for (const Counts& cells : {Counts{0, 1, 1}, Counts{1, 0, 1}, Counts{1, 1, 0}, Counts{0, 1, 0, 0, 1}})
        for (const bool offsets : {true, false})
            for (const std::int64_t points : {0, 3}) {
                const auto result = read_parts({cells, offsets, false, points});
                ASSERT_TRUE(result) << result.error().message;
                EXPECT_EQ(result->grid.cells.count(), 2u);
                ASSERT_EQ(result->grid.point_fields.size(), 1u);
                ASSERT_EQ(result->grid.cell_fields.size(), 1u);
                EXPECT_EQ(result->grid.cell_fields[0].values.at(1), 1);
                const auto last = static_cast<std::size_t>(result->grid.cells.connectivity.at(7));
                EXPECT_EQ(result->grid.points.at(last, 2), 1) << "the top of the second tet";
                EXPECT_EQ(result->grid.point_fields[0].values.at(last), result->grid.points.at(last, 0) + 3);
            }
}

TEST_F(ReadVtkhdfParts, MayHaveATypeOfAnyLength) {
    const auto result = read_parts({{1, 1}, true, true});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), 2u);
}

TEST_F(ReadVtkhdfParts, CountsOfDifferentLengthsAreAnError) {
    {
        Hdf5Writer file(folder_.file("a.vtkhdf"));
        write_parts(file, {{1, 1}});
    }
    for (const char* name : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"}) {
        {
            Hdf5Writer file(folder_.file("b.vtkhdf"));
            for (const char* group : {"/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/CellData"}) file.group(group);
            file.attribute("/VTKHDF", "Version", Counts{2, 0});
            file.attribute("/VTKHDF", "Type", "UnstructuredGrid");
            for (const char* count : {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"}) {
                const Counts values(std::string(count) == name ? 1 : 2, std::string(count) == "NumberOfCells" ? 1 : 4);
                file.data<std::int64_t>(std::string("/VTKHDF/") + count, values, {values.size()});
            }
            file.data<double>("/VTKHDF/Points", std::vector<double>(24, 0), {8, 3});
            file.data<std::int64_t>("/VTKHDF/Connectivity", {0, 1, 2, 3, 0, 1, 2, 3}, {8});
            file.data<std::int64_t>("/VTKHDF/Offsets", {0, 4, 0, 4}, {4});
            file.data<std::uint8_t>("/VTKHDF/Types", {10, 10}, {2});
        }
        const auto result = read(folder_.file("b.vtkhdf"));
        ASSERT_FALSE(result) << name;
        EXPECT_NE(result.error().message.find("each has one a part"), std::string::npos) << result.error().message;
    }
}

TEST_F(ReadVtkhdfParts, RowsOfNoPartAreSaid) {
    const auto result = read_with([](Hdf5Writer& file) {
        file.data<double>("/VTKHDF/PointData/p", {1, 2, 3, 4, 5, 6, 7}, {7});
        file.data<double>("/VTKHDF/CellData/c", {1, 2}, {2});
    });
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->notes,
              std::vector<std::string>{"rows that belong to no part were not read: \"PointData/p\" has 7 rows for 5"});
}

TEST_F(ReadVtkhdfParts, OneBadArrayDoesNotSpoilTheRest) {
    const auto bad = [](Hdf5Writer& file) {
        file.data<double>("/VTKHDF/PointData/short", {1, 2, 3}, {3});
        file.data<double>("/VTKHDF/PointData/cube", std::vector<double>(20, 1), {5, 2, 2});
        file.data<double>("/VTKHDF/PointData/single", {1}, {});
        file.stored<double>("/VTKHDF/PointData/begun", {1, 2, 3, 4, 5}, {5},
                            {.chunk = {2}, .unwritten = 2, .never_filled = true});
        file.stored<double>("/VTKHDF/CellData/none", {1, 2}, {2}, {.unwritten = 2, .never_filled = true});
        file.data<double>("/VTKHDF/PointData/p", {1, 2, 3, 4, 5}, {5});
    };
    const auto result = read_with(bad);
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->grid.point_fields.size(), 1u);
    EXPECT_EQ(result->grid.point_fields[0].name, "p");
    EXPECT_TRUE(result->grid.cell_fields.empty());
    EXPECT_EQ(result->info.left_out.size(), 5u);
    for (const char* name : {"short", "cube", "single", "begun"}) {
        ReadOptions options;
        options.point_fields = {name};
        EXPECT_EQ(read_with(bad, options).error().code, ErrorCode::invalid_data) << name;
    }
}

/// Points, indices and types that were never written are no numbers of the heap.
TEST_F(ReadVtkhdfParts, RefusesAMeshThatWasNeverWritten) {
    const auto error = [&](const std::string& unwritten) {
        {
            Hdf5Writer file(folder_.file("a.vtkhdf"));
            for (const char* name : {"/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/CellData"}) file.group(name);
            file.attribute("/VTKHDF", "Version", Counts{2, 0});
            file.attribute("/VTKHDF", "Type", "UnstructuredGrid");
            const auto way = [&](const std::string& name) {
                return Hdf5Writer::Storage{
                    .chunk = {2}, .unwritten = name == unwritten ? hsize_t{1} : 0, .never_filled = true};
            };
            Hdf5Writer::Storage of_points = way("Points");
            of_points.chunk = {1, 3};
            file.stored<std::int64_t>("/VTKHDF/NumberOfPoints", {5}, {1}, way("NumberOfPoints"));
            file.stored<std::int64_t>("/VTKHDF/NumberOfCells", {2}, {1}, way("NumberOfCells"));
            file.stored<std::int64_t>("/VTKHDF/NumberOfConnectivityIds", {8}, {1}, way("NumberOfConnectivityIds"));
            file.stored<double>("/VTKHDF/Points", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1}, {5, 3}, of_points);
            Hdf5Writer::Storage single = way("Types");
            single.chunk = {1};
            file.stored<std::uint8_t>("/VTKHDF/Types", {10, 10}, {2}, single);
            single = way("Connectivity");
            single.chunk = {1};
            file.stored<std::int64_t>("/VTKHDF/Connectivity", {0, 1, 2, 3, 0, 2, 1, 4}, {8}, single);
            file.stored<std::int64_t>("/VTKHDF/Offsets", {0, 4, 8}, {3}, way("Offsets"));
        }
        const auto result = read(folder_.file("a.vtkhdf"));
        return result ? "read" : result.error().message;
    };
    EXPECT_EQ(error(""), "read");
    for (const char* name :
         {"NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds", "Points", "Types", "Connectivity", "Offsets"})
        EXPECT_NE(error(name).find("never written"), std::string::npos) << name << ": " << error(name);
}

TEST_F(ReadVtkhdfParts, PointsMayBeIntegers) {
    {
        Hdf5Writer file(folder_.file("a.vtkhdf"));
        for (const char* name : {"/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/CellData"}) file.group(name);
        file.attribute("/VTKHDF", "Version", Counts{2, 0});
        file.attribute("/VTKHDF", "Type", "UnstructuredGrid");
        file.data<std::int64_t>("/VTKHDF/NumberOfPoints", {4}, {1});
        file.data<std::int64_t>("/VTKHDF/NumberOfCells", {1}, {1});
        file.data<std::int64_t>("/VTKHDF/NumberOfConnectivityIds", {4}, {1});
        file.data<std::int32_t>("/VTKHDF/Points", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 7}, {4, 3});
        file.data<std::uint8_t>("/VTKHDF/Types", {10}, {1});
        file.data<std::int64_t>("/VTKHDF/Connectivity", {0, 1, 2, 3}, {4});
        file.data<std::int64_t>("/VTKHDF/Offsets", {0, 4}, {2});
    }
    const auto result = read(folder_.file("a.vtkhdf"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.points.type(), ScalarType::float64);
    EXPECT_EQ(result->grid.points.at(3, 2), 7);
}

/// An image of 3 x 5 points a layer, whose box does not begin at 0.
void write_image(Hdf5Writer& file, std::vector<double> direction, std::int64_t last_layer = 2) {
    for (const char* name : {"/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/CellData"}) file.group(name);
    file.attribute("/VTKHDF", "Version", Counts{2, 0});
    file.attribute("/VTKHDF", "Type", "ImageData");
    file.attribute("/VTKHDF", "WholeExtent", Counts{1, 3, 0, 4, 0, last_layer});
    file.real_attribute("/VTKHDF", "Origin", {1, 2, 3});
    file.real_attribute("/VTKHDF", "Spacing", {0.5, 0.25, 1});
    file.real_attribute("/VTKHDF", "Direction", std::move(direction));
}

std::vector<double> counted(std::size_t count) {
    std::vector<double> values(count);
    std::iota(values.begin(), values.end(), 0.0);
    return values;
}

/// The places are those that VTK 9.7 gives.
TEST_F(ReadVtkhdfParts, PlacesThePointsOfImages) {
    {
        Hdf5Writer file(folder_.file("a.vtkhdf"));
        write_image(file, {0, 1, 0, 1, 0, 0, 0, 0, 1});
        file.data<double>("/VTKHDF/PointData/v", counted(135), {3, 5, 3, 3});
        file.data<double>("/VTKHDF/CellData/c", counted(16), {2, 4, 2});
        file.data<double>("/VTKHDF/CellData/short", counted(8), {2, 2, 2});
    }
    const auto result = read(folder_.file("a.vtkhdf"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), 16u);
    const auto place = [&](std::size_t point) {
        const Array& points = result->grid.points;
        return std::array{points.at(point, 0), points.at(point, 1), points.at(point, 2)};
    };
    EXPECT_EQ(place(1), (std::array{1.0, 3.0, 3.0}));
    EXPECT_EQ(place(4), (std::array{1.25, 3.0, 3.0}));
    ASSERT_EQ(result->grid.point_fields.size(), 1u);
    EXPECT_EQ(result->grid.point_fields[0].values.at(3, 2), 11);
    ASSERT_EQ(result->grid.cell_fields.size(), 1u);
    EXPECT_EQ(result->grid.cell_fields[0].values.at(15, 0), 15);
    ASSERT_EQ(result->info.left_out.size(), 1u);
    EXPECT_EQ(result->info.left_out[0].name, "short");
    EXPECT_EQ(inspect(folder_.file("a.vtkhdf")).value().left_out.size(), 1u);
}

TEST_F(ReadVtkhdfParts, ImagesOfOneLayerOfPointsAreQuadrilaterals) {
    {
        Hdf5Writer file(folder_.file("a.vtkhdf"));
        write_image(file, {1, 0, 0, 0, 1, 0, 0, 0, 1}, 0);
        file.data<double>("/VTKHDF/CellData/c", counted(8), {1, 4, 2});
    }
    const auto result = read(folder_.file("a.vtkhdf"));
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->grid.cells.count(), 8u);
    EXPECT_EQ(result->grid.cells.types.at(7), 9);
    EXPECT_EQ(result->grid.cell_fields.at(0).values.at(7), 7);
}

TEST_F(ReadVtkhdfParts, LeavesOutCellsOfHiddenPointsOfImages) {
    std::vector<std::uint8_t> marks(45, 1); // of another piece
    marks[0] = 2;
    {
        Hdf5Writer file(folder_.file("a.vtkhdf"));
        write_image(file, {1, 0, 0, 0, 1, 0, 0, 0, 1});
        file.data<std::uint8_t>("/VTKHDF/PointData/vtkGhostType", marks, {3, 5, 3});
        file.data<double>("/VTKHDF/CellData/c", counted(16), {2, 4, 2});
    }
    const auto result = read(folder_.file("a.vtkhdf"));
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->grid.cells.count(), 15u);
    EXPECT_EQ(result->grid.cell_fields.at(0).values.at(0), 1);
    EXPECT_EQ(result->info.fields.size(), 1u);
}

TEST_F(ReadVtkhdfParts, ReadsTheStepOfAnImageThatIsAskedFor) {
    {
        Hdf5Writer file(folder_.file("a.vtkhdf"));
        write_image(file, {1, 0, 0, 0, 1, 0, 0, 0, 1});
        file.group("/VTKHDF/Steps");
        file.data<double>("/VTKHDF/Steps/Values", {0, 0.5}, {2});
        file.data<double>("/VTKHDF/PointData/p", counted(90), {2, 3, 5, 3});
    }
    ReadOptions options;
    options.step = 1;
    const auto result = read(folder_.file("a.vtkhdf"), options);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->info.times, (std::vector<double>{0, 0.5}));
    EXPECT_EQ(result->grid.point_fields.at(0).values.at(1, 0), 46);
}

TEST_F(ReadVtkhdfParts, LeavesUnwrittenFieldsOfImagesOut) {
    {
        Hdf5Writer file(folder_.file("a.vtkhdf"));
        for (const char* name : {"/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/CellData"}) file.group(name);
        file.attribute("/VTKHDF", "Version", Counts{1, 0});
        file.attribute("/VTKHDF", "Type", "ImageData");
        file.attribute("/VTKHDF", "WholeExtent", Counts{0, 1, 0, 1, 0, 1});
        file.real_attribute("/VTKHDF", "Origin", {0, 0, 0});
        file.real_attribute("/VTKHDF", "Spacing", {1, 1, 1});
        file.real_attribute("/VTKHDF", "Direction", {1, 0, 0, 0, 1, 0, 0, 0, 1});
        file.data<double>("/VTKHDF/PointData/p", {1, 2, 3, 4, 5, 6, 7, 8}, {2, 2, 2});
        file.stored<double>("/VTKHDF/PointData/q", {1, 2, 3, 4, 5, 6, 7, 8}, {2, 2, 2},
                            {.chunk = {1, 2, 2}, .unwritten = 1, .never_filled = true});
    }
    const auto result = read(folder_.file("a.vtkhdf"));
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->grid.point_fields.size(), 1u);
    EXPECT_EQ(result->grid.point_fields[0].name, "p");
    ASSERT_EQ(result->info.left_out.size(), 1u);
    EXPECT_EQ(result->info.left_out[0].name, "q");
}

/// 2 x 3 x 4 points of such a type.
void write_box(Hdf5Writer& file, const std::string& group, const char* type) {
    for (const char* part : {"", "/PointData", "/CellData"}) file.group(group + part);
    file.attribute(group, "Version", Counts{2, 7});
    file.attribute(group, "Type", type);
    file.attribute(group, "Dimensions", Counts{2, 3, 4});
    file.data<float>(group + "/PointData/v", std::vector<float>(72, 3), {4, 3, 2, 3});
    file.data<double>(group + "/CellData/c", counted(6), {3, 2, 1});
}

/// As VTK 9.7 writes them.
TEST_F(ReadVtkhdfParts, ReadsRectilinearAndStructuredGrids) {
    const std::string path = folder_.file("a.vtkhdf");
    for (const bool rectilinear : {true, false}) {
        {
            Hdf5Writer file(path);
            write_box(file, "/VTKHDF", rectilinear ? "RectilinearGrid" : "StructuredGrid");
            if (rectilinear) {
                file.data<double>("/VTKHDF/XCoordinates", {0, 0.5}, {2});
                file.data<std::int64_t>("/VTKHDF/YCoordinates", {0, 1, 3}, {3});
                file.data<float>("/VTKHDF/ZCoordinates", {0, 1, 2, 7}, {4});
            } else {
                std::vector<double> corners;
                for (const double z : {0, 1, 2, 7})
                    for (const double y : {0, 1, 3})
                        for (const double x : {0.0, 0.5}) corners.insert(corners.end(), {x, y, z});
                file.data<double>("/VTKHDF/Points", corners, {4, 3, 2, 3});
            }
        }
        const auto result = read(path);
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->grid.cells.count(), 6u);
        ASSERT_EQ(result->grid.points.tuples(), 24u);
        EXPECT_EQ(result->grid.points.at(23, 0), 0.5);
        EXPECT_EQ(result->grid.points.at(4, 1), 3);
        EXPECT_EQ(result->grid.points.at(23, 2), 7);
        EXPECT_EQ(result->grid.point_fields.at(0).values.components(), 3u);
        EXPECT_EQ(result->grid.cell_fields.at(0).values.at(5), 5);
    }
    {
        Hdf5Writer file(path);
        write_box(file, "/VTKHDF", "StructuredGrid");
        file.data<double>("/VTKHDF/Points", counted(48), {4, 2, 2, 3});
    }
    EXPECT_NE(read(path).error().message.find("Points are not those of a grid of 2 x 3 x 4 points"), std::string::npos);
    {
        Hdf5Writer file(path);
        write_box(file, "/VTKHDF", "RectilinearGrid");
        for (const char* name : {"XCoordinates", "YCoordinates", "ZCoordinates"})
            file.data<double>(std::string("/VTKHDF/") + name, {0, 1}, {2});
    }
    EXPECT_FALSE(read(path));
}

TEST_F(ReadVtkhdfParts, StepsNameTheirPlacesInStructuredGrids) {
    {
        Hdf5Writer file(folder_.file("a.vtkhdf"));
        for (const char* name : {"/VTKHDF", "/VTKHDF/PointData", "/VTKHDF/Steps", "/VTKHDF/Steps/PointDataOffsets"})
            file.group(name);
        file.attribute("/VTKHDF", "Version", Counts{2, 7});
        file.attribute("/VTKHDF", "Type", "RectilinearGrid");
        file.attribute("/VTKHDF", "Dimensions", Counts{2, 2, 2});
        file.data<double>("/VTKHDF/Steps/Values", {0, 1, 2}, {3});
        file.data<std::int64_t>("/VTKHDF/Steps/XCoordinatesOffsets", {0, 0, 2}, {3});
        file.data<std::int64_t>("/VTKHDF/Steps/PointDataOffsets/p", {0, 1, 0, 2}, {4});
        file.data<double>("/VTKHDF/XCoordinates", {0, 1, 0, 5}, {4});
        file.data<double>("/VTKHDF/YCoordinates", {0, 1}, {2});
        file.data<double>("/VTKHDF/ZCoordinates", {0, 1}, {2});
        file.data<double>("/VTKHDF/PointData/p", counted(16), {2, 2, 2, 2});
    }
    for (const auto& [step, x, p] : {std::tuple{0u, 1.0, 7.0}, {1u, 1.0, 15.0}, {2u, 5.0, 7.0}}) {
        ReadOptions options;
        options.step = step;
        const auto result = read(folder_.file("a.vtkhdf"), options);
        ASSERT_TRUE(result) << result.error().message;
        EXPECT_EQ(result->grid.points.at(7, 0), x) << step;
        EXPECT_EQ(result->grid.point_fields.at(0).values.at(7), p) << step;
    }
}

TEST_F(ReadVtkhdfParts, ImagesOfACollectionAreBlocks) {
    {
        Hdf5Writer file(folder_.file("a.vtkhdf"));
        file.group("/VTKHDF");
        file.attribute("/VTKHDF", "Version", Counts{2, 3});
        file.attribute("/VTKHDF", "Type", "PartitionedDataSetCollection");
        for (const std::int64_t at : {0, 1}) {
            const std::string group = at == 0 ? "/VTKHDF/right" : "/VTKHDF/left"; // by Index, not by name
            for (const char* part : {"", "/PointData", "/CellData"}) file.group(group + part);
            file.attribute(group, "Type", "ImageData");
            file.attribute(group, "Index", Counts{at});
            file.attribute(group, "WholeExtent", Counts{0, 1, 0, 1, 0, 1});
            file.real_attribute(group, "Origin", {static_cast<double>(at), 0, 0});
            file.real_attribute(group, "Spacing", {1, 1, 1});
            file.data<double>(group + "/CellData/c", {static_cast<double>(10 + at)}, {1, 1, 1});
        }
    }
    const auto all = read(folder_.file("a.vtkhdf"));
    ASSERT_TRUE(all) << all.error().message;
    EXPECT_EQ(all->grid.cells.count(), 2u);
    EXPECT_EQ(all->grid.points.tuples(), 12u) << "joined";
    ASSERT_EQ(all->info.blocks.size(), 2u);
    EXPECT_EQ(all->info.blocks[1].name, "left");
    EXPECT_EQ(all->info.blocks[1].cells, 1u);
    ReadOptions options;
    options.blocks = {"left"};
    const auto left = read(folder_.file("a.vtkhdf"), options);
    ASSERT_TRUE(left) << left.error().message;
    EXPECT_EQ(left->grid.cell_fields.at(0).values.at(0), 11);
}

} // namespace
} // namespace isotet::test
