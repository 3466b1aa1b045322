// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Structured grids are hexahedra.
#include <gtest/gtest.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkStructuredGrid.h>
#include <vtkStructuredGridWriter.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLRectilinearGridWriter.h>
#include <vtkXMLStructuredGridWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <isotet/read.hpp>

#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

template <class Writer, class Data>
void write(Data* data, const std::string& path) {
    vtkNew<vtkDoubleArray> values;
    values->SetName("s");
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) values->InsertNextValue(static_cast<double>(i));
    data->GetPointData()->AddArray(values);
    vtkNew<Writer> writer;
    writer->SetFileName(path.c_str());
    writer->SetInputData(data);
    writer->Write();
}

/// A grid of 3 x 4 x 5 points whose last point is at (2, 3, 4) and whose first hexahedron is the one at the origin.
void expect_hexahedra(const std::string& path) {
    const auto result = read(path);
    ASSERT_TRUE(result) << result.error().message;
    const Grid& grid = result->grid;
    ASSERT_EQ(grid.points.tuples(), 60u);
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_EQ(grid.points.at(59, axis), 2.0 + static_cast<double>(axis));
    EXPECT_EQ(grid.cells.uniform_type, CellType::hexahedron);
    ASSERT_EQ(grid.cells.count(), 24u);
    const std::vector<double> corners = {0, 1, 4, 3, 12, 13, 16, 15};
    for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(grid.cells.connectivity.at(i), corners[i]);
    EXPECT_EQ(grid.point_fields.at(0).values.at(59), 59);
    ASSERT_EQ(result->notes.size(), 1u);
    EXPECT_EQ(result->notes[0], "a structured grid of 3 x 4 x 5 points was read as 24 hexahedra");
}

TEST(ReadStructured, ImageDataIsHexahedra) {
    const TemporaryFolder folder;
    vtkNew<vtkImageData> image;
    image->SetDimensions(3, 4, 5);
    write<vtkXMLImageDataWriter>(image.Get(), folder.file("a.vti"));
    expect_hexahedra(folder.file("a.vti"));
}

TEST(ReadStructured, RectilinearGridIsHexahedra) {
    const TemporaryFolder folder;
    vtkNew<vtkRectilinearGrid> grid;
    grid->SetDimensions(3, 4, 5);
    vtkNew<vtkDoubleArray> ticks[3];
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 3 + axis; ++i) ticks[axis]->InsertNextValue(i);
    grid->SetXCoordinates(ticks[0]);
    grid->SetYCoordinates(ticks[1]);
    grid->SetZCoordinates(ticks[2]);
    write<vtkXMLRectilinearGridWriter>(grid.Get(), folder.file("a.vtr"));
    expect_hexahedra(folder.file("a.vtr"));
}

vtkNew<vtkStructuredGrid> structured_grid() {
    vtkNew<vtkStructuredGrid> grid;
    grid->SetDimensions(3, 4, 5);
    vtkNew<vtkPoints> points;
    for (int z = 0; z < 5; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 3; ++x) points->InsertNextPoint(x, y, z);
    grid->SetPoints(points);
    return grid;
}

TEST(ReadStructured, StructuredGridIsHexahedra) {
    const TemporaryFolder folder;
    const auto grid = structured_grid();
    write<vtkXMLStructuredGridWriter>(grid.Get(), folder.file("a.vts"));
    expect_hexahedra(folder.file("a.vts"));
}

/// Point 0 is hidden, and one within; others are marked as another piece's, which hides nothing.
void hide_points(vtkDataSet* data) {
    vtkNew<vtkUnsignedCharArray> marks;
    marks->SetName("vtkGhostType");
    for (int point = 0; point < 60; ++point) marks->InsertNextValue(point == 0 ? 2 : point == 28 ? 3 : point % 2);
    data->GetPointData()->AddArray(marks);
}

/// Of 24 cells one has the first point, and eight the other.
void expect_hidden(const std::string& path, const std::vector<bool>& visible) {
    SCOPED_TRACE(path);
    const auto result = read(path);
    ASSERT_TRUE(result) << result.error().message;
    std::vector<int> corners;
    for (int cell = 0; cell < 24; ++cell)
        if (visible[static_cast<std::size_t>(cell)]) corners.push_back(cell % 2 + 3 * (cell / 2 % 3) + 12 * (cell / 6));
    ASSERT_EQ(result->grid.cells.count(), corners.size());
    for (std::size_t i = 0; i < corners.size(); ++i)
        EXPECT_EQ(result->grid.points.at(static_cast<std::size_t>(result->grid.cells.connectivity.at(8 * i)), 0),
                  corners[i] % 3);
    EXPECT_EQ(result->info.fields.size(), 1u);
    ASSERT_EQ(result->notes.size(), 2u);
    EXPECT_EQ(result->notes[1], "9 ghost or blanked cells were left out");
}

TEST(ReadStructured, CellsAtHiddenPointsAreLeftOut) {
    const TemporaryFolder folder;
    const auto grid = structured_grid();
    hide_points(grid);
    std::vector<bool> visible;
    for (vtkIdType cell = 0; cell < 24; ++cell) visible.push_back(grid->IsCellVisible(cell) != 0);
    write<vtkXMLStructuredGridWriter>(grid.Get(), folder.file("a.vts"));
    expect_hidden(folder.file("a.vts"), visible);
    write<vtkStructuredGridWriter>(grid.Get(), folder.file("a.vtk"));
    expect_hidden(folder.file("a.vtk"), visible);
    vtkNew<vtkImageData> image;
    image->SetDimensions(3, 4, 5);
    hide_points(image);
    write<vtkXMLImageDataWriter>(image.Get(), folder.file("a.vti"));
    expect_hidden(folder.file("a.vti"), visible);
}

TEST(ReadStructured, HiddenPointsOfUnstructuredGridsHideNoCells) {
    const TemporaryFolder folder;
    vtkNew<vtkUnstructuredGrid> grid;
    vtkNew<vtkPoints> points;
    for (int i = 0; i < 60; ++i) points->InsertNextPoint(i % 2, i / 2 % 2, i / 4);
    grid->SetPoints(points);
    const vtkIdType corners[] = {0, 1, 2, 4};
    grid->InsertNextCell(VTK_TETRA, 4, corners);
    hide_points(grid);
    write<vtkXMLUnstructuredGridWriter>(grid.Get(), folder.file("a.vtu"));
    const auto result = read(folder.file("a.vtu"));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.cells.count(), 1u);
}

} // namespace
} // namespace isotet::test
