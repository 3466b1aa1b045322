// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What isotet writes, read back by VTK's own readers: the same bits.
#include <cstring>

#include <vtkCell.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCommand.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkOBJReader.h>
#include <vtkNew.h>
#include <vtkPLYReader.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkSTLReader.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <isotet/make.hpp>
#include <isotet/write.hpp>

#include "files/sample_files.hpp"

namespace isotet::test {
namespace {

/// Fails the test when a VTK object reports an error or a warning; not all of them set an error code.
class ComplaintFails : public vtkCommand {
public:
    static ComplaintFails* New() { return new ComplaintFails; }
    void Execute(vtkObject*, unsigned long, void* message) override {
        ADD_FAILURE() << static_cast<const char*>(message);
    }
};

template <class Reader>
auto read_with(const std::string& path) {
    auto reader = vtkSmartPointer<Reader>::New();
    reader->SetFileName(path.c_str());
    const auto complaint_fails = vtkSmartPointer<ComplaintFails>::New();
    reader->AddObserver(vtkCommand::ErrorEvent, complaint_fails);
    reader->AddObserver(vtkCommand::WarningEvent, complaint_fails);
    if constexpr (requires { reader->ReadAllScalarsOn(); }) {
        reader->ReadAllScalarsOn();
        reader->ReadAllFieldsOn();
    }
    reader->Update();
    EXPECT_EQ(reader->GetErrorCode(), 0U) << path;
    return vtkSmartPointer(reader->GetOutput());
}

TEST(VtkReadsBack, ArraysOfTheFileAsAWhole) {
    const Folder folder;
    WriteOptions options;
    options.field_data = {{"isotet:x", Array::own(std::vector<double>{1, 2, 0.3})}};
    const auto expect_there = [&](vtkPolyData* surface) {
        vtkDataArray* const array = surface->GetFieldData()->GetArray("isotet:x");
        ASSERT_TRUE(array);
        EXPECT_EQ(array->GetNumberOfTuples(), 3);
        EXPECT_EQ(array->GetComponent(2, 0), 0.3);
        EXPECT_GT(surface->GetNumberOfPolys(), 0);
    };
    ASSERT_TRUE(write_surface(bare_surface(), folder / "out.vtp", options));
    expect_there(read_with<vtkXMLPolyDataReader>(folder / "out.vtp"));
    ASSERT_TRUE(write_surface(bare_surface(), folder / "out.vtk", options));
    expect_there(read_with<vtkPolyDataReader>(folder / "out.vtk"));
}

template <class Reader>
auto written_and_read(const Surface& surface, const std::string& ending) {
    const Folder folder;
    const auto report = write_surface(surface, folder / ("out." + ending));
    EXPECT_TRUE(report) << report.error().message;
    return read_with<Reader>(folder / ("out." + ending));
}

void expect_same(vtkDataArray* array, const Array& expected, const char* what) {
    ASSERT_TRUE(array) << what;
    EXPECT_EQ(static_cast<std::size_t>(array->GetNumberOfTuples()), expected.tuples()) << what;
    EXPECT_EQ(static_cast<std::size_t>(array->GetNumberOfComponents()), expected.components()) << what;
    EXPECT_EQ(static_cast<std::size_t>(array->GetDataTypeSize()), size_of(expected.type())) << what;
    ASSERT_EQ(static_cast<std::size_t>(array->GetDataSize()) * size_of(expected.type()), expected.bytes()) << what;
    EXPECT_EQ(std::memcmp(array->GetVoidPointer(0), expected.data(), expected.bytes()), 0) << what;
}

std::vector<vtkIdType> corners_of(vtkCellArray* cells) {
    std::vector<vtkIdType> corners;
    for (vtkIdType i = 0; i < cells->GetNumberOfCells(); ++i) {
        vtkIdType count = 0;
        const vtkIdType* cell = nullptr;
        cells->GetCellAtId(i, count, cell);
        corners.insert(corners.end(), cell, cell + count);
    }
    return corners;
}

std::vector<vtkIdType> corners_of(const Array& array) {
    return array.visit([](auto values) { return std::vector<vtkIdType>(values.begin(), values.end()); });
}

void expect_same_fields(vtkPolyData* data) {
    const Surface surface = rich_surface();
    auto* points = data->GetPointData();
    expect_same(points->GetArray("edge_ends"), surface.edge_ends, "edge ends");
    expect_same(points->GetArray("edge_weights"), surface.edge_weights, "edge weights");
    expect_same(points->GetArray("pressure"), surface.point_fields[0].values, "pressure");
    expect_same(points->GetArray("gmsh:velocity"), surface.point_fields[2].values, "velocity");
    auto* temperature = points->GetArray("temperature (K) [mean]");
    ASSERT_TRUE(temperature);
    EXPECT_EQ(temperature->GetComponent(0, 0), 298.125);
    expect_same(data->GetCellData()->GetArray("source_cell"), surface.source_cells, "source cells");
    expect_same(data->GetCellData()->GetArray("region"), surface.cell_fields[0].values, "region");
    expect_same(data->GetCellData()->GetArray("big"), surface.cell_fields[1].values, "big");
}

TEST(VtkReadsVtp, WithTheSameBits) {
    const auto data = written_and_read<vtkXMLPolyDataReader>(rich_surface(), "vtp");
    expect_same(data->GetPoints()->GetData(), rich_surface().positions, "positions");
    EXPECT_EQ(corners_of(data->GetPolys()), corners_of(rich_surface().triangles));
    expect_same_fields(data);
    EXPECT_TRUE(data->GetPointData()->GetArray("caf%E9 %01<&\"'>"));
}

TEST(VtkReadsLegacy, WithTheSameBits) {
    const auto data = written_and_read<vtkPolyDataReader>(rich_surface(), "vtk");
    expect_same(data->GetPoints()->GetData(), rich_surface().positions, "positions");
    EXPECT_EQ(corners_of(data->GetPolys()), corners_of(rich_surface().triangles));
    expect_same_fields(data);
    EXPECT_TRUE(data->GetPointData()->GetArray("caf\xE9 \x01<&\"'>"));
}

/// One field of every type, on the points of a bare surface.
Surface surface_of_every_type() {
    Surface surface = bare_surface();
    const auto add = [&]<class Scalar>(const char* name, Scalar) {
        const auto low = std::numeric_limits<Scalar>::lowest(), high = std::numeric_limits<Scalar>::max();
        surface.point_fields.push_back({name, Array::own(std::vector<Scalar>{low, 0, 1, 77, high})});
    };
    add("int8", std::int8_t{});
    add("uint8", std::uint8_t{});
    add("int16", std::int16_t{});
    add("uint16", std::uint16_t{});
    add("int32", std::int32_t{});
    add("uint32", std::uint32_t{});
    add("int64", std::int64_t{});
    add("uint64", std::uint64_t{});
    add("float32", float{});
    add("float64", double{});
    return surface;
}

TEST(VtkReadsVtp, WithEveryTypeOfField) {
    const Surface surface = surface_of_every_type();
    const auto data = written_and_read<vtkXMLPolyDataReader>(surface, "vtp");
    for (const auto& field : surface.point_fields)
        expect_same(data->GetPointData()->GetArray(field.name.c_str()), field.values, field.name.c_str());
}

TEST(VtkReadsLegacy, WithEveryTypeOfField) {
    const Surface surface = surface_of_every_type();
    const auto data = written_and_read<vtkPolyDataReader>(surface, "vtk");
    for (const auto& field : surface.point_fields)
        expect_same(data->GetPointData()->GetArray(field.name.c_str()), field.values, field.name.c_str());
}

template <class Reader>
void expect_normals(const std::string& ending) {
    Surface surface = bare_surface();
    surface.normals_kind = Normals::gradient;
    surface.normals = Array::own(std::vector<float>{0, 0, 1, 0, 1, 0, 1, 0, 0, 0, 0, -1, 0.6F, 0.8F, 0}, 3);
    expect_same(written_and_read<Reader>(surface, ending)->GetPointData()->GetNormals(), surface.normals,
                "normals of points");
    if (ending == "ply" || ending == "obj") return; // VTK reads none of faces from these
    surface.normals_kind = Normals::face;
    surface.normals = Array::own(std::vector<float>{0, 0, 1, 0, 1, 0, 1, 0, 0}, 3);
    expect_same(written_and_read<Reader>(surface, ending)->GetCellData()->GetNormals(), surface.normals,
                "normals of faces");
}

TEST(VtkReadsVtp, WithNormals) { expect_normals<vtkXMLPolyDataReader>("vtp"); }
TEST(VtkReadsLegacy, WithNormals) { expect_normals<vtkPolyDataReader>("vtk"); }
TEST(VtkReadsPly, WithNormals) { expect_normals<vtkPLYReader>("ply"); }

TEST(VtkReadsPly, WithTheSameBits) {
    const auto data = written_and_read<vtkPLYReader>(rich_surface(), "ply");
    expect_same(data->GetPoints()->GetData(), rich_surface().positions, "positions");
    EXPECT_EQ(corners_of(data->GetPolys()), corners_of(rich_surface().triangles));
}

TEST(VtkReadsObj, WithTheSameBits) {
    const auto data = written_and_read<vtkOBJReader>(rich_surface(), "obj");
    expect_same(data->GetPoints()->GetData(), rich_surface().positions, "positions");
    EXPECT_EQ(corners_of(data->GetPolys()), corners_of(rich_surface().triangles));
}

TEST(VtkReadsStl, WithTheSameCorners) {
    const Folder folder;
    ASSERT_TRUE(write_surface(bare_surface(), folder / "out.stl"));
    const auto reader = vtkSmartPointer<vtkSTLReader>::New();
    reader->SetFileName((folder / "out.stl").c_str());
    reader->MergingOff();
    reader->Update();
    auto* data = reader->GetOutput();
    ASSERT_EQ(data->GetNumberOfPolys(), 3);
    const auto corners = corners_of(data->GetPolys()), expected = corners_of(bare_surface().triangles);
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(data->GetPoint(corners[i])[k],
                      bare_surface().positions.at(static_cast<std::size_t>(expected[i]), static_cast<std::size_t>(k)));
        }
    }
}

TEST(VtkReadsVtp, WithPositionsInDouble) {
    const Surface surface = moved(bare_surface(), {4200000.125, -0.1, 1e-9});
    const auto data = written_and_read<vtkXMLPolyDataReader>(surface, "vtp");
    EXPECT_EQ(data->GetPoints()->GetDataType(), VTK_DOUBLE);
    EXPECT_EQ(data->GetPoint(1)[0], 4200001.125);
}

template <class Reader>
void expect_empty(const std::string& ending) {
    const auto data = written_and_read<Reader>(empty_surface(), ending);
    EXPECT_EQ(data->GetNumberOfPoints(), 0) << ending;
    EXPECT_EQ(data->GetNumberOfCells(), 0) << ending;
}

TEST(VtkReadsVtp, WithCompression) {
    const Surface surface = rich_surface();
    for (const Compression compression : {Compression::zlib, Compression::lz4})
        for (const Surface& written : {surface, empty_surface()}) {
            const Folder folder;
            ASSERT_TRUE(write_surface(written, folder / "out.vtp", {.compression = compression}));
            const auto data = read_with<vtkXMLPolyDataReader>(folder / "out.vtp");
            ASSERT_EQ(static_cast<std::size_t>(data->GetNumberOfPoints()), written.vertex_count());
            ASSERT_EQ(static_cast<std::size_t>(data->GetNumberOfPolys()), written.triangle_count());
            if (written.vertex_count() == 0) continue;
            expect_same(data->GetPoints()->GetData(), written.positions, "positions");
            EXPECT_EQ(corners_of(data->GetPolys()), corners_of(written.triangles));
        }
}

TEST(VtkReadsEmptySurfaces, FromVtp) { expect_empty<vtkXMLPolyDataReader>("vtp"); }
TEST(VtkReadsEmptySurfaces, FromLegacy) { expect_empty<vtkPolyDataReader>("vtk"); }
TEST(VtkReadsEmptySurfaces, FromPly) { expect_empty<vtkPLYReader>("ply"); }
TEST(VtkReadsEmptySurfaces, FromStl) { expect_empty<vtkSTLReader>("stl"); }
TEST(VtkReadsEmptySurfaces, FromObj) { expect_empty<vtkOBJReader>("obj"); }

template <class Reader>
void expect_grid(const Grid& grid, const std::string& ending, Compression compression = Compression::none) {
    const Folder folder;
    const auto report = write_grid(grid, folder / ("out." + ending), {.compression = compression});
    ASSERT_TRUE(report) << report.error().message;
    EXPECT_EQ(report->bytes, std::filesystem::file_size(folder / ("out." + ending)));
    const auto data = read_with<Reader>(folder / ("out." + ending));
    expect_same(data->GetPoints()->GetData(), grid.points, "points");
    expect_same(data->GetPointData()->GetArray("field one"), grid.point_fields[0].values, "point field");
    expect_same(data->GetCellData()->GetArray("v"), grid.cell_fields[0].values, "cell field");
    const bool uniform = grid.cells.offsets.empty();
    std::vector<vtkIdType> corners = corners_of(grid.cells.connectivity);
    if (!uniform)
        corners.erase(corners.begin(), corners.begin() + static_cast<std::ptrdiff_t>(grid.cells.offsets.at(0)));
    EXPECT_EQ(corners_of(data->GetCells()), corners);
    ASSERT_EQ(data->GetNumberOfCells(), 2);
    EXPECT_EQ(data->GetCellType(0), 10);
    EXPECT_EQ(data->GetCellType(1), uniform ? 10 : 14);
}

TEST(VtkReadsVtu, WithUniformCells) { expect_grid<vtkXMLUnstructuredGridReader>(tet_grid(), "vtu"); }
TEST(VtkReadsVtu, WithMixedCells) { expect_grid<vtkXMLUnstructuredGridReader>(mixed_grid(), "vtu"); }
TEST(VtkReadsVtu, WithPolyhedra) {
    const Folder folder;
    MakeOptions options;
    options.shape = "kelvin";
    options.side = 2;
    const Grid grid = make_grid(options).value();
    ASSERT_TRUE(write_grid(grid, folder / "foam.vtu"));
    vtkNew<vtkXMLUnstructuredGridReader> reader;
    reader->SetFileName((folder / "foam.vtu").c_str());
    reader->Update();
    vtkUnstructuredGrid* const read = reader->GetOutput();
    ASSERT_EQ(read->GetNumberOfCells(), 16);
    for (vtkIdType cell = 0; cell < 16; ++cell) {
        ASSERT_EQ(read->GetCellType(cell), 42);
        EXPECT_EQ(read->GetCell(cell)->GetNumberOfFaces(), 14);
        EXPECT_EQ(read->GetCell(cell)->GetNumberOfPoints(), 24);
        EXPECT_EQ(read->GetCell(cell)->GetNumberOfEdges(), 36);
    }
}

TEST(VtkReadsVtu, WithCompression) {
    for (const Compression compression : {Compression::zlib, Compression::lz4}) {
        expect_grid<vtkXMLUnstructuredGridReader>(tet_grid(), "vtu", compression);
        expect_grid<vtkXMLUnstructuredGridReader>(mixed_grid(), "vtu", compression);
    }
}
TEST(VtkReadsLegacyGrid, WithUniformCells) { expect_grid<vtkUnstructuredGridReader>(tet_grid(), "vtk"); }
TEST(VtkReadsLegacyGrid, WithMixedCells) { expect_grid<vtkUnstructuredGridReader>(mixed_grid(), "vtk"); }

} // namespace
} // namespace isotet::test
