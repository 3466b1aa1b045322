// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Structured grids are hexahedra.
#include <gtest/gtest.h>
#include <vtkDoubleArray.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkStructuredGrid.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLRectilinearGridWriter.h>
#include <vtkXMLStructuredGridWriter.h>

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

TEST(ReadStructured, StructuredGridIsHexahedra) {
    const TemporaryFolder folder;
    vtkNew<vtkStructuredGrid> grid;
    grid->SetDimensions(3, 4, 5);
    vtkNew<vtkPoints> points;
    for (int z = 0; z < 5; ++z)
        for (int y = 0; y < 4; ++y)
            for (int x = 0; x < 3; ++x) points->InsertNextPoint(x, y, z);
    grid->SetPoints(points);
    write<vtkXMLStructuredGridWriter>(grid.Get(), folder.file("a.vts"));
    expect_hexahedra(folder.file("a.vts"));
}

} // namespace
} // namespace isotet::test
