// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polyhedra of VTKHDF (since version 2.5): partitions, steps, and what is broken.
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "vtk_readers/hdf5_writer.hpp"
#include "vtk_readers/polyhedral_files.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

/// The data sets of a file by name, each with the rows of all partitions.
struct HdfColumns {
    std::vector<double> points, values[2], cell_values;
    std::vector<std::uint8_t> types;
    std::map<std::string, std::vector<std::int64_t>> integers;

    /// Appends a partition: the cells [begin, end) of a grid, on their own points.
    void add(const Grid& grid, std::size_t begin, std::size_t end, double shift = 0) {
        std::map<std::int64_t, std::int64_t> own; // by the number in the grid, so the order stays
        const auto reader = core::FaceReader::open(grid.cells).value();
        const FaceTable table(grid);
        for (std::size_t cell = begin; cell < end; ++cell)
            for (const std::int64_t point : corners_of_cell(grid, cell)) own[point] = 0;
        std::int64_t next = 0;
        for (auto& [point, number] : own) {
            number = next++;
            for (std::size_t axis = 0; axis < 3; ++axis)
                points.push_back(grid.points.at(static_cast<std::size_t>(point), axis) + (axis == 0 ? shift : 0));
            for (std::size_t f = 0; f < 2; ++f)
                values[f].push_back(grid.point_fields[f].values.at(static_cast<std::size_t>(point)));
        }
        auto& offsets = integers["Offsets"];
        auto& polyhedra = integers["PolyhedronOffsets"];
        auto& to_faces = integers["PolyhedronToFaces"];
        auto& connectivity = integers["Connectivity"];
        const std::size_t first_corner = connectivity.size(), first_face = to_faces.size();
        std::map<std::int64_t, std::int64_t> own_faces; // in the order of their first cell
        std::vector<std::int64_t> face_order;
        offsets.push_back(0);
        polyhedra.push_back(0);
        std::size_t polyhedron = 0;
        for (std::size_t cell = 0; cell < end; ++cell) {
            const bool has_faces = reader.begin(cell) < reader.end(cell);
            if (cell >= begin) {
                for (const std::int64_t point : corners_of_cell(grid, cell)) connectivity.push_back(own[point]);
                offsets.push_back(static_cast<std::int64_t>(connectivity.size() - first_corner));
                types.push_back(static_cast<std::uint8_t>(grid.cells.types.at(cell)));
                cell_values.push_back(static_cast<double>(cell));
                if (has_faces)
                    for (const std::int64_t face : table.cells[polyhedron]) {
                        const auto [place, is_new] =
                            own_faces.emplace(face, static_cast<std::int64_t>(face_order.size()));
                        if (is_new) face_order.push_back(face);
                        to_faces.push_back(place->second);
                    }
                polyhedra.push_back(static_cast<std::int64_t>(to_faces.size() - first_face));
            }
            if (has_faces) ++polyhedron;
        }
        auto& face_points = integers["FaceConnectivity"];
        const std::size_t first_face_point = face_points.size();
        integers["FaceOffsets"].push_back(0);
        for (const std::int64_t face : face_order) {
            for (const std::int64_t point : table.faces[static_cast<std::size_t>(face)])
                face_points.push_back(own[point]);
            integers["FaceOffsets"].push_back(static_cast<std::int64_t>(face_points.size() - first_face_point));
        }
        integers["NumberOfPoints"].push_back(next);
        integers["NumberOfCells"].push_back(static_cast<std::int64_t>(end - begin));
        integers["NumberOfConnectivityIds"].push_back(static_cast<std::int64_t>(connectivity.size() - first_corner));
        integers["NumberOfFaces"].push_back(static_cast<std::int64_t>(face_order.size()));
        integers["NumberOfFaceConnectivityIds"].push_back(
            static_cast<std::int64_t>(face_points.size() - first_face_point));
        integers["NumberOfPolyhedronToFaceIds"].push_back(static_cast<std::int64_t>(to_faces.size() - first_face));
    }

    void write(Hdf5Writer& file, const std::string& group = "/VTKHDF") const {
        for (const char* name : {"", "/PointData", "/CellData", "/FieldData"}) file.group(group + name);
        file.attribute(group, "Version", std::vector<std::int64_t>{2, 5});
        file.attribute(group, "Type", "UnstructuredGrid");
        file.data(group + "/Points", points, {points.size() / 3, 3});
        file.data(group + "/Types", types, {types.size()});
        for (const auto& [name, numbers] : integers) file.data(group + "/" + name, numbers, {numbers.size()});
        file.data(group + "/PointData/f", values[0], {values[0].size()});
        file.data(group + "/PointData/g", values[1], {values[1].size()});
        file.data(group + "/CellData/c", cell_values, {cell_values.size()});
    }
};

Result<ReadResult> read_columns(const HdfColumns& columns, const ReadOptions& options = {},
                                const std::function<void(Hdf5Writer&)>& more = {}) {
    const TemporaryFolder folder;
    {
        Hdf5Writer file(folder.file("a.vtkhdf"));
        columns.write(file);
        if (more) more(file);
    }
    return read(folder.file("a.vtkhdf"), options);
}

TEST(VtkhdfPolyhedra, HaveNoHolesAndGiveThePlaneOfALinearField) {
    const Grid sample = octree_for_files();
    HdfColumns columns;
    columns.add(sample, 0, sample.cells.count());
    const auto result = read_columns(columns);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.faces.type(), ScalarType::int32);
    expect_sound_polyhedra(result->grid);
    EXPECT_EQ(survey(result->grid).value().tets, survey(sample).value().tets);
}

TEST(VtkhdfPolyhedra, ThatAreHexahedraGiveTheirSurface) {
    const Grid hexahedra = hexahedra_for_files();
    HdfColumns columns;
    columns.add(as_polyhedra(hexahedra, Listed::ascending, 4), 0, hexahedra.cells.count());
    const auto result = read_columns(columns);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(survey(result->grid).value().cells_by_type.at(42), hexahedra.cells.count());
    expect_surface_of(hexahedra, result->grid);
    expect_sound_polyhedra(result->grid);
}

TEST(VtkhdfPolyhedra, OfSeveralPartitionsFit) {
    const Grid sample = octree_for_files();
    const std::size_t cells = sample.cells.count();
    HdfColumns columns;
    for (std::size_t part = 0; part < 4; ++part) columns.add(sample, cells * part / 4, cells * (part + 1) / 4);
    const auto result = read_columns(columns);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), cells);
    EXPECT_EQ(survey(result->grid).value().cells_by_type, survey(sample).value().cells_by_type);
    expect_sound_polyhedra(result->grid);
}

TEST(VtkhdfPolyhedra, AreMissingInPartitionsWithoutThem) {
    const Grid hexahedra = hexahedra_for_files();
    HdfColumns columns;
    columns.add(as_polyhedra(hexahedra, Listed::ascending, 4), 0, 20);
    Grid typed = hexahedra;
    std::vector<std::int64_t> offsets;
    for (std::size_t i = 0; i <= hexahedra.cells.count(); ++i) offsets.push_back(static_cast<std::int64_t>(8 * i));
    typed.cells.offsets = Array::own(std::move(offsets));
    typed.cells.types = Array::own(std::vector<std::uint8_t>(hexahedra.cells.count(), 12));
    columns.add(typed, 20, hexahedra.cells.count());
    const auto result = read_columns(columns);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(survey(result->grid).value().cells_by_type.at(42), 20u);
    expect_sound_polyhedra(result->grid);
}

/// VTK's writer gives the tables of steps an entry for each partition; others one for each step.
TEST(VtkhdfPolyhedra, OfStepsAreThoseOfTheirPartitions) {
    const Grid first = octree_for_files(3), second = octree_for_files(4);
    HdfColumns columns;
    std::vector<std::int64_t> face_places, point_places, to_face_places;
    const auto add = [&](const Grid& grid, std::size_t begin, std::size_t end) {
        const auto sum = [&](const char* name) {
            std::int64_t all = 0;
            for (const std::int64_t count : columns.integers[name]) all += count;
            return all;
        };
        face_places.push_back(sum("NumberOfFaces"));
        point_places.push_back(sum("NumberOfFaceConnectivityIds"));
        to_face_places.push_back(sum("NumberOfPolyhedronToFaceIds"));
        columns.add(grid, begin, end);
    };
    const std::size_t half = first.cells.count() / 2;
    add(first, 0, half);
    add(first, half, first.cells.count());
    add(second, 0, second.cells.count());
    const auto& points = columns.integers["NumberOfPoints"];
    const auto& corners = columns.integers["NumberOfConnectivityIds"];
    for (const bool by_part : {true, false}) {
        const auto steps = [&](Hdf5Writer& file) {
            file.group("/VTKHDF/Steps");
            file.data<double>("/VTKHDF/Steps/Values", {1, 2}, {2});
            const auto table = [&](const char* name, const std::vector<std::int64_t>& numbers) {
                file.data(std::string("/VTKHDF/Steps/") + name, numbers, {numbers.size()});
            };
            table("PartOffsets", {0, 2});
            table("NumberOfParts", {2, 1});
            table("PointOffsets", {0, points[0] + points[1]});
            table("CellOffsets", {0, static_cast<std::int64_t>(first.cells.count())});
            table("ConnectivityIdOffsets", {0, corners[0] + corners[1]});
            const auto of_faces = [&](const char* name, const std::vector<std::int64_t>& starts) {
                table(name, by_part ? starts : std::vector<std::int64_t>{starts[0], starts[2]});
            };
            of_faces("FaceOffsetsOffsets", face_places);
            of_faces("FaceConnectivityOffsets", point_places);
            of_faces("PolyhedronToFaceIdOffsets", to_face_places);
        };
        for (const std::size_t step : {0, 1}) {
            ReadOptions options;
            options.step = step;
            const auto result = read_columns(columns, options, steps);
            ASSERT_TRUE(result) << result.error().message;
            EXPECT_EQ(result->grid.cells.count(), (step == 0 ? first : second).cells.count());
            expect_sound_polyhedra(result->grid);
        }
    }
}

/// Three data sets, whose order is that of their indices, and one of another type.
std::string write_collection(const TemporaryFolder& folder, const Grid& sample, const char* type) {
    const std::size_t cells = sample.cells.count();
    Hdf5Writer file(folder.file("a.vtkhdf"));
    file.group("/VTKHDF");
    file.attribute("/VTKHDF", "Version", std::vector<std::int64_t>{2, 5});
    file.attribute("/VTKHDF", "Type", type);
    const std::vector<std::string> names{"rock", "fault", "ore body"};
    for (std::size_t i = 0; i < names.size(); ++i) {
        HdfColumns columns;
        columns.add(sample, cells * i / 3, cells * (i + 1) / 3);
        columns.write(file, "/VTKHDF/" + names[i]);
        file.attribute("/VTKHDF/" + names[i], "Index", std::vector<std::int64_t>{static_cast<std::int64_t>(i)});
    }
    file.group("/VTKHDF/surface");
    file.attribute("/VTKHDF/surface", "Type", "PolyData");
    file.group("/VTKHDF/Assembly");
    return folder.file("a.vtkhdf");
}

TEST(VtkhdfCollections, AreBlocksThatFitAndCanBeChosen) {
    const Grid sample = octree_for_files();
    const std::size_t cells = sample.cells.count();
    for (const char* type : {"PartitionedDataSetCollection", "MultiBlockDataSet"}) {
        const TemporaryFolder folder;
        const std::string path = write_collection(folder, sample, type);
        const auto info = inspect(path);
        ASSERT_TRUE(info) << info.error().message;
        ASSERT_EQ(info->blocks.size(), 3u);
        EXPECT_EQ(info->blocks[2].name, "ore body");
        EXPECT_EQ(info->blocks[2].number, 3);
        EXPECT_EQ(info->blocks[1].cells, cells * 2 / 3 - cells / 3);
        const auto all = read(path);
        ASSERT_TRUE(all) << all.error().message;
        EXPECT_EQ(all->grid.cells.count(), cells);
        expect_sound_polyhedra(all->grid);
        ASSERT_FALSE(all->notes.empty());
        EXPECT_NE(all->notes.back().find("'surface' is left out: it is of type PolyData"), std::string::npos)
            << all->notes[0];
        ReadOptions options;
        options.blocks = {"fault", "3"};
        const auto two = read(path, options);
        ASSERT_TRUE(two) << two.error().message;
        EXPECT_EQ(two->grid.cells.count(), cells - cells / 3);
        options.blocks = {"gas"};
        const auto none = read(path, options);
        ASSERT_FALSE(none);
        EXPECT_NE(none.error().message.find("which has 1 'rock', 2 'fault', 3 'ore body'"), std::string::npos)
            << none.error().message;
    }
}

/// A polyhedron with four faces beside a tetrahedron.
HdfColumns two_cells() {
    PolyhedronList list;
    list.add_linear(10, {0, 1, 2, 3});
    list.add({{1, 2, 3}, {1, 2, 4}, {1, 3, 4}, {2, 3, 4}});
    Grid grid = tet_grid<double>({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}, {});
    grid.cells = list.cells();
    HdfColumns columns;
    columns.add(with_fields_for_files(grid), 0, 2);
    return columns;
}

std::string message_with(const std::string& name, const std::vector<std::int64_t>& numbers) {
    HdfColumns columns = two_cells();
    columns.integers[name] = numbers;
    const auto result = read_columns(columns);
    return result ? "read" : result.error().message;
}

TEST(VtkhdfPolyhedra, ThatAreBrokenAreErrors) {
    const HdfColumns good = two_cells();
    ASSERT_TRUE(read_columns(good));
    const auto expect = [](const std::string& message, const std::string& part) {
        EXPECT_NE(message.find("a.vtkhdf: "), std::string::npos) << message;
        EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    expect(message_with("FaceConnectivity", {1, 2, 3, 1, 2, 4, 1, 3, 4, 2, 3, 5}), "has a face with point 5");
    expect(message_with("FaceConnectivity", {1, 2, 3, 1, 2, 4, 1, 3, 4, 2, 3, -4}), "has a face with point -4");
    expect(message_with("FaceConnectivity", {1, 2, 3, 1, 2, 4, 1, 3, 4, 2, 3}),
           "\"/VTKHDF/FaceConnectivity\" has 11 rows, but 12");
    expect(message_with("FaceOffsets", {0, 3, 9, 6, 12}), "face 2 has points 9 to 6 of 12");
    expect(message_with("FaceOffsets", {0, 3, 6, 9, 13}), "face 3 has points 9 to 13 of 12");
    expect(message_with("FaceOffsets", {-3, 3, 6, 9, 12}), "face 0 has points -3 to 3");
    expect(message_with("FaceOffsets", {0, 3, 6, 9}), "\"/VTKHDF/FaceOffsets\" has 4 rows, but 5");
    expect(message_with("PolyhedronToFaces", {0, 1, 2, 4}), "a polyhedron has face 4, but there are 4 faces");
    expect(message_with("PolyhedronToFaces", {0, 1, 2, -1}), "a polyhedron has face -1, but there are 4 faces");
    expect(message_with("PolyhedronOffsets", {0, 5, 4}), "cell 0 has faces 0 to 5 of 4");
    expect(message_with("PolyhedronOffsets", {0, 0}), "\"/VTKHDF/PolyhedronOffsets\" has 2 rows, but 3");
    expect(message_with("NumberOfFaces", {5}), "\"/VTKHDF/FaceOffsets\" has 5 rows, but 6");
    expect(message_with("NumberOfFaces", {-1}), "which is no count");
    expect(message_with("NumberOfFaceConnectivityIds", {std::int64_t{1} << 50}), "has 12 rows, but 1125899906842624");
    expect(message_with("NumberOfPolyhedronToFaceIds", {3}), "cell 1 has faces 0 to 4 of 3");
    expect(message_with("NumberOfPolyhedronToFaceIds", {}), "\"/VTKHDF/NumberOfPolyhedronToFaceIds\" has 0 rows");
}

TEST(VtkhdfPolyhedra, WithoutDataSetsOfFacesAreLeftOut) {
    HdfColumns columns = two_cells();
    for (const char* name : {"FaceConnectivity", "FaceOffsets", "PolyhedronToFaces", "PolyhedronOffsets"})
        columns.integers.erase(name);
    const auto result = read_columns(columns);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(survey(result->grid).value().cells_left_out, 1u);
}

/// A few faces named by very many cells must not fill the memory.
TEST(VtkhdfPolyhedra, ThatShareAFaceTooOftenAreAnError) {
    HdfColumns columns = two_cells();
    std::vector<std::int64_t> long_face(3000);
    for (std::size_t i = 0; i < long_face.size(); ++i) long_face[i] = static_cast<std::int64_t>(i % 5);
    columns.integers["FaceConnectivity"] = long_face;
    columns.integers["NumberOfFaceConnectivityIds"] = {3000};
    columns.integers["FaceOffsets"] = {0, 3000};
    columns.integers["NumberOfFaces"] = {1};
    columns.integers["PolyhedronToFaces"].assign(1000, 0);
    columns.integers["NumberOfPolyhedronToFaceIds"] = {1000};
    columns.integers["PolyhedronOffsets"] = {0, 0, 1000};
    const auto result = read_columns(columns);
    ASSERT_FALSE(result);
    EXPECT_NE(result.error().message.find("a face has two sides"), std::string::npos) << result.error().message;
}

} // namespace
} // namespace isotet::test
