// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids whose cells are implied: their points and hexahedra are written out.
#include <vtkImageData.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkStructuredGrid.h>

#include "io/confined/structured.hpp"
#include "io/confined/vtk_grid.hpp"
#include "io/vtk_xml/load.hpp"

namespace isotet::io::confined {
namespace {

Array implied_points(vtkDataSet* data) {
    std::vector<double> points(3 * static_cast<std::size_t>(data->GetNumberOfPoints()));
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) data->GetPoint(i, points.data() + 3 * i);
    return Array::own(std::move(points), 3);
}

} // namespace

Result<std::optional<Grid>> hexahedra_of(vtkDataSet* data, std::vector<std::string>& notes) {
    int dimensions[3] = {0, 0, 0};
    Grid grid;
    if (auto* structured = vtkStructuredGrid::SafeDownCast(data)) {
        structured->GetDimensions(dimensions);
        if (structured->GetPoints()) grid.points = shared_array(structured->GetPoints()->GetData());
    } else if (auto* image = vtkImageData::SafeDownCast(data)) {
        image->GetDimensions(dimensions);
        grid.points = implied_points(data);
    } else if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(data)) {
        rectilinear->GetDimensions(dimensions);
        grid.points = implied_points(data);
    } else {
        return std::optional<Grid>();
    }
    auto cells =
        vtk_xml::hexahedra_of({static_cast<std::uint64_t>(dimensions[0]), static_cast<std::uint64_t>(dimensions[1]),
                               static_cast<std::uint64_t>(dimensions[2])},
                              notes);
    if (!cells) return cells.error();
    grid.cells = std::move(*cells);
    return std::optional(std::move(grid));
}

} // namespace isotet::io::confined
