// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sections of CGNS in any order, with boundary elements anywhere among those of the volume; several solutions.
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "support/temporary_folder.hpp"

#include <vtk_cgns.h> // last: its macros rename common words
#include VTK_CGNS(cgnslib.h)
#include VTK_CGNS(cgns_io.h)

namespace isotet::test {
namespace {

using Points = std::vector<cgsize_t>;

/// Two hexahedra, a wedge and a tetrahedron in a row along x; the number of a cell is in its field.
const std::vector<std::vector<double>> corner_places{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1},
                                                     {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {2, 0, 0}, {2, 1, 0},
                                                     {2, 0, 1}, {2, 1, 1}, {3, 0, 0}, {3, 0, 1}, {4, 0, 0}};
const std::vector<Points> volume{
    {1, 2, 3, 4, 5, 6, 7, 8}, {2, 9, 10, 3, 6, 11, 12, 7}, {9, 13, 10, 11, 14, 12}, {13, 15, 10, 14}};
const std::vector<Points> boundary{{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 13, 10}};

/// A file that is being written.
struct CgnsWriter {
    int file = 0, base = 0, zone = 0, at = 0;

    explicit CgnsWriter(const std::string& path, bool surface_first = false) {
        cg_set_file_type(CG_FILE_HDF5);
        EXPECT_EQ(cg_open(path.c_str(), CG_MODE_WRITE, &file), 0) << cg_get_error();
        if (surface_first) {
            cg_base_write(file, "Skin", 2, 3, &base);
            triangle();
        }
        cg_base_write(file, "Base", 3, 3, &base);
        const cgsize_t size[3] = {static_cast<cgsize_t>(corner_places.size()), static_cast<cgsize_t>(volume.size()), 0};
        cg_zone_write(file, base, "Zone", size, CG_Unstructured, &zone);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::vector<double> values;
            for (const auto& place : corner_places) values.push_back(place[axis]);
            const char name[] = {'C', 'o', 'o', 'r', 'd', 'i', 'n', 'a', 't', 'e', "XYZ"[axis], '\0'};
            cg_coord_write(file, base, zone, CG_RealDouble, name, values.data(), &at);
        }
    }
    void triangle() {
        const cgsize_t size[3] = {3, 1, 0};
        cg_zone_write(file, base, "Triangle", size, CG_Unstructured, &zone);
        const std::vector<double> places{0, 1, 0};
        for (const char* name : {"CoordinateX", "CoordinateY", "CoordinateZ"})
            cg_coord_write(file, base, zone, CG_RealDouble, name, places.data(), &at);
        section("Tri", CG_TRI_3, 1, 1, {1, 2, 3});
    }
    void section(const char* name, CG_ElementType_t type, cgsize_t first, cgsize_t last, const Points& points) {
        EXPECT_EQ(cg_section_write(file, base, zone, name, type, first, last, 0, points.data(), &at), 0)
            << cg_get_error();
    }
    void mixed(cgsize_t first, const std::vector<Points>& elements, bool with_offsets) {
        Points numbers, offsets{0};
        for (const Points& points : elements) {
            numbers.push_back(points.size() == 3   ? CG_TRI_3
                              : points.size() == 4 ? points[0] < 10 ? CG_QUAD_4 : CG_TETRA_4
                              : points.size() == 6 ? CG_PENTA_6
                                                   : CG_HEXA_8);
            numbers.insert(numbers.end(), points.begin(), points.end());
            offsets.push_back(static_cast<cgsize_t>(numbers.size()));
        }
        EXPECT_EQ(cg_poly_section_write(file, base, zone, "Mixed", CG_MIXED, first,
                                        first + static_cast<cgsize_t>(elements.size()) - 1, 0, numbers.data(),
                                        offsets.data(), &at),
                  0)
            << cg_get_error();
        if (!with_offsets) remove_node("/Base/Zone/Mixed", "ElementStartOffset");
    }
    void remove_node(const char* parent, const char* name) const {
        int tree = 0;
        double root = 0, node = 0, child = 0;
        cg_get_cgio(file, &tree);
        cgio_get_root_id(tree, &root);
        ASSERT_EQ(cgio_get_node_id(tree, root, parent, &node), 0);
        ASSERT_EQ(cgio_get_node_id(tree, node, name, &child), 0);
        ASSERT_EQ(cgio_delete_node(tree, node, child), 0);
    }
    /// The same number of letters.
    void rename_location(const std::string& parent, const char* location) const {
        int tree = 0;
        double root = 0, node = 0;
        cg_get_cgio(file, &tree);
        cgio_get_root_id(tree, &root);
        ASSERT_EQ(cgio_get_node_id(tree, root, (parent + "/GridLocation").c_str(), &node), 0);
        ASSERT_EQ(cgio_write_all_data(tree, node, location), 0);
    }
    void solution(const char* name, CG_GridLocation_t location, const char* field, std::vector<double> values) {
        int number = 0;
        cg_sol_write(file, base, zone, name, location, &number);
        if (!values.empty()) cg_field_write(file, base, zone, number, CG_RealDouble, field, values.data(), &at);
    }
    void discrete(const char* name, CG_GridLocation_t location,
                  const std::vector<std::pair<const char*, std::vector<double>>>& arrays) const {
        int number = 0;
        cg_discrete_write(file, base, zone, name, &number);
        cg_goto(file, base, "Zone_t", zone, "DiscreteData_t", number, "end");
        cg_gridlocation_write(location);
        for (const auto& [array, values] : arrays) {
            const auto count = static_cast<cgsize_t>(values.size());
            EXPECT_EQ(cg_array_write(array, CG_RealDouble, 1, &count, values.data()), 0) << cg_get_error();
        }
    }
    void close_with_an_empty_zone() {
        const cgsize_t size[3] = {8, 1, 0};
        int hollow = 0;
        cg_zone_write(file, base, "Hollow", size, CG_Unstructured, &hollow);
        close();
    }
    void close() {
        solution("Empty", CG_Vertex, "", {});
        std::vector<double> x;
        for (const auto& place : corner_places) x.push_back(place[0]);
        solution("Nodal", CG_Vertex, "T", x);
        solution("Cells", CG_CellCenter, "q", {0, 1, 2, 3});
        EXPECT_EQ(cg_close(file), 0) << cg_get_error();
    }
};

Points all_of(const std::vector<Points>& elements) {
    Points all;
    for (const Points& points : elements) all.insert(all.end(), points.begin(), points.end());
    return all;
}

/// The field of cells tells which one each should be.
void expect_cells(const std::string& path) {
    const auto result = read(path);
    ASSERT_TRUE(result) << result.error().message;
    const Grid& grid = result->grid;
    ASSERT_EQ(grid.cells.count(), volume.size());
    ASSERT_EQ(grid.cell_fields.size(), 1u);
    std::size_t at = 0;
    for (std::size_t cell = 0; cell < volume.size(); ++cell) {
        const Points& points = volume[static_cast<std::size_t>(grid.cell_fields[0].values.at(cell))];
        for (const cgsize_t point : points)
            EXPECT_EQ(grid.cells.connectivity.at(at++), static_cast<double>(point - 1)) << cell;
    }
    EXPECT_EQ(at, grid.cells.connectivity.size());
    ASSERT_EQ(grid.point_fields.size(), 1u);
    for (std::size_t i = 0; i < corner_places.size(); ++i)
        EXPECT_EQ(grid.point_fields[0].values.at(i), corner_places[i][0]);
    EXPECT_EQ(result->info.blocks.at(0).cells, volume.size());
    EXPECT_TRUE(result->info.times.empty());
}

TEST(CgnsSections, BoundaryConditionsArePatches) {
    const TemporaryFolder folder;
    CgnsWriter file(folder.file("patches.cgns"));
    file.mixed(1, boundary, true);
    file.section("Hexahedra", CG_HEXA_8, 4, 5, all_of({volume[0], volume[1]}));
    file.section("Wedge", CG_PENTA_6, 6, 6, volume[2]);
    file.section("Tetrahedron", CG_TETRA_4, 7, 7, volume[3]);
    const Points bottom{1, 2}, whole_range{1, 7}, top{5, 6, 7, 8};
    const auto condition = [&](const char* name, CG_PointSetType_t kind, const Points& points,
                               CG_GridLocation_t location) {
        int number = 0;
        EXPECT_EQ(cg_boco_write(file.file, file.base, file.zone, name, CG_BCWall, kind,
                                static_cast<cgsize_t>(points.size()), points.data(), &number),
                  0)
            << cg_get_error();
        cg_boco_gridlocation_write(file.file, file.base, file.zone, number, location);
    };
    condition("faces", CG_PointRange, bottom, CG_FaceCenter);
    condition("points", CG_PointList, top, CG_Vertex);
    condition("with cells", CG_PointRange, whole_range, CG_FaceCenter);
    file.close();
    ReadOptions options;
    options.patches = true;
    const auto result = read(folder.file("patches.cgns"), options);
    ASSERT_TRUE(result) << result.error().message;
    const BoundaryPatches& patches = result->grid.patches;
    ASSERT_EQ(patches.names.size(), 3u);
    EXPECT_EQ(patches.names[1].name, "points");
    const auto numbers = patches.numbers.as<std::int64_t>(), offsets = patches.offsets.as<std::int64_t>();
    EXPECT_EQ(std::vector<std::int64_t>(numbers.begin(), numbers.end()), (std::vector<std::int64_t>{0, 0, 1, 2, 2, 2}));
    EXPECT_EQ(std::vector<std::int64_t>(offsets.begin(), offsets.end()),
              (std::vector<std::int64_t>{0, 4, 8, 12, 16, 20, 23}));
    EXPECT_EQ(patches.points.at(8), 4);
}

TEST(CgnsSections, MayStandInAnyOrderAndNumberTheBoundaryFirst) {
    const TemporaryFolder folder;
    const Points hexahedra = all_of({volume[0], volume[1]}), quads = all_of({boundary[0], boundary[1]});
    enum SectionKind { hexahedron, wedge, tetrahedron, quad, triangle };
    // The numbers of the elements stay in this order of kinds; the sections are written in the other.
    const std::vector<std::vector<SectionKind>> numbered{{hexahedron, wedge, tetrahedron, quad, triangle},
                                                         {quad, triangle, hexahedron, wedge, tetrahedron},
                                                         {quad, hexahedron, wedge, triangle, tetrahedron}};
    int files = 0;
    for (const auto& order : numbered)
        for (const bool backwards : {false, true}) {
            const std::string path = folder.file(std::to_string(files++) + ".cgns");
            CgnsWriter writer(path);
            std::vector<std::pair<SectionKind, cgsize_t>> firsts;
            cgsize_t next = 1;
            for (const SectionKind kind : order) {
                firsts.emplace_back(kind, next);
                next += kind == hexahedron || kind == quad ? 2 : 1;
            }
            if (backwards) std::swap(firsts.front(), firsts.back()), std::swap(firsts[1], firsts[3]);
            for (const auto& [kind, first] : firsts) {
                if (kind == hexahedron) writer.section("Hexa", CG_HEXA_8, first, first + 1, hexahedra);
                if (kind == wedge) writer.section("Penta", CG_PENTA_6, first, first, volume[2]);
                if (kind == tetrahedron) writer.section("Tetra", CG_TETRA_4, first, first, volume[3]);
                if (kind == quad) writer.section("Quad", CG_QUAD_4, first, first + 1, quads);
                if (kind == triangle) writer.section("Tri", CG_TRI_3, first, first, boundary[2]);
            }
            writer.close();
            SCOPED_TRACE(path);
            expect_cells(path);
        }
}

TEST(CgnsSections, MayMixTheBoundaryWithTheVolume) {
    const TemporaryFolder folder;
    int files = 0;
    for (const bool with_offsets : {false, true})
        for (const bool boundary_first : {false, true}) {
            const std::string path = folder.file(std::to_string(files++) + ".cgns");
            CgnsWriter writer(path);
            std::vector<Points> elements = volume;
            if (boundary_first) elements.insert(elements.begin(), boundary.begin(), boundary.end());
            else elements.insert(elements.begin() + 2, boundary.begin(), boundary.end());
            writer.mixed(1, elements, with_offsets);
            writer.close();
            SCOPED_TRACE(path);
            expect_cells(path);
        }
}

TEST(CgnsBases, TheFirstWithVolumesIsReadWithoutZonesThatHaveNoPoints) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.cgns");
    CgnsWriter writer(path, true);
    writer.mixed(1, volume, true);
    writer.close_with_an_empty_zone();
    const auto result = read(path);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), volume.size());
    ASSERT_EQ(result->notes.size(), 2u);
    EXPECT_EQ(result->notes[0], "only the first with volumes of 2 bases is read, 'Base': `block` NAME reads 'Skin'");
    EXPECT_EQ(result->notes[1], "zone \"Base/Hollow\" is left out: it has no coordinates");
}

TEST(CgnsSections, OfMixedElementsThatAreBrokenAreErrors) {
    const TemporaryFolder folder;
    const auto expect = [&](const std::vector<Points>& elements, const std::string& part) {
        const std::string path = folder.file("broken.cgns");
        CgnsWriter writer(path);
        writer.mixed(1, elements, true);
        writer.close();
        const auto result = read(path);
        ASSERT_FALSE(result) << part;
        EXPECT_NE(result.error().message.find("zone \"Base/Zone\": section \"Mixed\" " + part), std::string::npos)
            << result.error().message;
    };
    std::vector<Points> elements = volume;
    elements[1][3] = 16;
    expect(elements, "has an element with point 16, but the points are 1 to 15");
}

TEST(CgnsSolutions, OfOneNameAreTwoFieldsAndThoseElsewhereAreTold) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.cgns");
    CgnsWriter writer(path);
    writer.mixed(1, volume, true);
    writer.solution("Before", CG_Vertex, "T", std::vector<double>(corner_places.size(), 7));
    writer.solution("Faces", CG_CellCenter, "flux", std::vector<double>(4, 1));
    writer.rename_location("/Base/Zone/Faces", "FaceCenter");
    writer.close();
    const auto result = read(path);
    ASSERT_TRUE(result) << result.error().message;
    ASSERT_EQ(result->grid.point_fields.size(), 2u);
    EXPECT_EQ(result->grid.point_fields[0].name, "T");
    EXPECT_EQ(result->grid.point_fields[0].values.at(8), 7);
    EXPECT_EQ(result->grid.point_fields[1].name, "Nodal/T");
    EXPECT_EQ(result->grid.point_fields[1].values.at(8), 2);
    ASSERT_EQ(result->notes.size(), 1u);
    EXPECT_EQ(result->notes[0], "field 'flux' is left out: its values are at \"FaceCenter\" (solution \"Faces\")");
}

TEST(CgnsDiscreteData, IsReadAsFieldsAtItsLocationBehindSolutions) {
    const TemporaryFolder folder;
    const std::string path = folder.file("a.cgns");
    CgnsWriter writer(path);
    writer.mixed(1, volume, true);
    const std::vector<double> nodal(corner_places.size(), 5), cells{4, 3, 2, 1};
    writer.discrete("Nodes", CG_Vertex, {{"T", nodal}, {"Distance", nodal}});
    writer.discrete("Middles", CG_CellCenter, {{"VOL", cells}});
    writer.discrete("Elsewhere", CG_CellCenter, {{"flux", cells}});
    writer.rename_location("/Base/Zone/Elsewhere", "FaceCenter");
    writer.close();
    const auto result = read(path);
    ASSERT_TRUE(result) << result.error().message;
    std::map<std::string, double> points, middles; // one value of each
    for (const Field& field : result->grid.point_fields) points[field.name] = field.values.at(8);
    for (const Field& field : result->grid.cell_fields) middles[field.name] = field.values.at(1);
    EXPECT_EQ(points, (std::map<std::string, double>{{"T", 2}, {"Nodes/T", 5}, {"Distance", 5}}))
        << "T of the solution, though it is written later";
    EXPECT_EQ(middles, (std::map<std::string, double>{{"q", 1}, {"VOL", 3}}));
    ASSERT_EQ(result->notes.size(), 1u);
    EXPECT_NE(result->notes[0].find("'flux' is left out"), std::string::npos) << result->notes[0];
}

TEST(CgnsSolutions, AreThoseOfTheirSteps) {
    const TemporaryFolder folder;
    for (const bool with_pointers : {false, true}) {
        const std::string path = folder.file(with_pointers ? "a.cgns" : "b.cgns");
        CgnsWriter writer(path);
        writer.mixed(1, volume, true);
        writer.solution("S1", CG_Vertex, "p", std::vector<double>(corner_places.size(), 1));
        writer.solution("S2", CG_Vertex, with_pointers ? "p" : "q", std::vector<double>(corner_places.size(), 2));
        if (with_pointers) writer.solution("S3", CG_Vertex, "rest", std::vector<double>(corner_places.size(), 3));
        cg_biter_write(writer.file, writer.base, "Steps", 2);
        cg_goto(writer.file, writer.base, "BaseIterativeData_t", 1, "end");
        const cgsize_t count = 2;
        const double times[] = {0.5, 1.5};
        cg_array_write("TimeValues", CG_RealDouble, 1, &count, times);
        if (with_pointers) {
            cg_ziter_write(writer.file, writer.base, writer.zone, "Steps");
            cg_goto(writer.file, writer.base, "Zone_t", writer.zone, "ZoneIterativeData_t", 1, "end");
            const cgsize_t size[2] = {32, 2};
            std::string names = "S2";
            names.resize(32, ' ');
            names += "S1";
            names.resize(64, ' ');
            cg_array_write("FlowSolutionPointers", CG_Character, 2, size, names.c_str());
        }
        ASSERT_EQ(cg_close(writer.file), 0) << cg_get_error();
        for (const std::size_t step : {0, 1}) {
            ReadOptions options;
            options.step = step;
            const auto result = read(path, options);
            ASSERT_TRUE(result) << result.error().message;
            EXPECT_EQ(result->info.times, (std::vector<double>{0.5, 1.5}));
            ASSERT_EQ(result->grid.point_fields.size(), with_pointers ? 2u : 1u);
            EXPECT_EQ(inspect(path, options).value().fields.size(), result->grid.point_fields.size()) << "of the step";
            EXPECT_EQ(inspect(path).value().fields.size(), 2u) << "of all";
            EXPECT_EQ(result->grid.point_fields[0].values.at(3),
                      with_pointers ? 2 - static_cast<double>(step) : 1 + static_cast<double>(step));
        }
    }
}

TEST(CgnsStructured, PlanesAreQuadrilaterals) {
    const TemporaryFolder folder;
    for (const int dimensions : {2, 3}) {
        const std::string path = folder.file(fmt::format("plane{}.cgns", dimensions));
        int file = 0, base = 0, zone = 0, at = 0;
        cg_set_file_type(CG_FILE_HDF5);
        ASSERT_EQ(cg_open(path.c_str(), CG_MODE_WRITE, &file), 0) << cg_get_error();
        cg_base_write(file, "Base", dimensions, 3, &base);
        const Points sizes = dimensions == 2 ? Points{3, 4, 2, 3, 0, 0} : Points{3, 4, 1, 2, 3, 0, 0, 0, 0};
        ASSERT_EQ(cg_zone_write(file, base, "Zone", sizes.data(), CG_Structured, &zone), 0) << cg_get_error();
        std::vector<double> x, y, z(12, 5), c(12);
        for (int i = 0; i < 12; ++i) x.push_back(i % 3), y.push_back(i / 3);
        std::iota(c.begin(), c.end(), 0.0);
        cg_coord_write(file, base, zone, CG_RealDouble, "CoordinateX", x.data(), &at);
        cg_coord_write(file, base, zone, CG_RealDouble, "CoordinateY", y.data(), &at);
        cg_coord_write(file, base, zone, CG_RealDouble, "CoordinateZ", z.data(), &at);
        const bool of_cells = dimensions == 2; // with no layer of cells libcgns writes no values of them
        cg_sol_write(file, base, zone, "Flow", of_cells ? CG_CellCenter : CG_Vertex, &at);
        ASSERT_EQ(cg_field_write(file, base, zone, at, CG_RealDouble, "c", c.data(), &at), 0) << cg_get_error();
        cg_close(file);
        const auto result = read(path);
        ASSERT_TRUE(result) << dimensions << ": " << result.error().message;
        ASSERT_EQ(result->grid.cells.count(), 6u);
        EXPECT_EQ(result->grid.cells.types.at(5), 9);
        EXPECT_EQ(result->grid.points.at(11, 1), 3);
        const std::vector<Field>& fields = of_cells ? result->grid.cell_fields : result->grid.point_fields;
        EXPECT_EQ(fields.at(0).values.at(5), 5);
    }
}

} // namespace
} // namespace isotet::test
