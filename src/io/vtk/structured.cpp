// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids whose cells are implied: their points and hexahedra are written out.
#include <fmt/core.h>
#include <vtkImageData.h>
#include <vtkPoints.h>
#include <vtkRectilinearGrid.h>
#include <vtkStructuredGrid.h>

#include "io/vtk/structured.hpp"
#include "io/vtk/vtk_grid.hpp"

namespace isotet::io::vtk {
namespace {

struct Size {
    std::uint64_t x, y, z;
};

template <class Index>
Array hexahedra(const Size& points) {
    std::vector<Index> corners;
    if (points.x > 1 && points.y > 1 && points.z > 1)
        corners.reserve(8 * (points.x - 1) * (points.y - 1) * (points.z - 1));
    const auto row = static_cast<Index>(points.x), slice = static_cast<Index>(points.x * points.y);
    for (std::uint64_t z = 0; z + 1 < points.z; ++z)
        for (std::uint64_t y = 0; y + 1 < points.y; ++y)
            for (std::uint64_t x = 0; x + 1 < points.x; ++x) {
                const auto p = static_cast<Index>((z * points.y + y) * points.x + x);
                const auto top = static_cast<Index>(p + slice);
                for (const Index corner :
                     {p, static_cast<Index>(p + 1), static_cast<Index>(p + row + 1), static_cast<Index>(p + row), top,
                      static_cast<Index>(top + 1), static_cast<Index>(top + row + 1), static_cast<Index>(top + row)})
                    corners.push_back(corner);
            }
    return Array::own(std::move(corners));
}

Array implied_points(vtkDataSet* data) {
    std::vector<double> points(3 * static_cast<std::size_t>(data->GetNumberOfPoints()));
    for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) data->GetPoint(i, points.data() + 3 * i);
    return Array::own(std::move(points), 3);
}

} // namespace

std::optional<Grid> hexahedra_of(vtkDataSet* data, std::vector<std::string>& notes) {
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
        return std::nullopt;
    }
    const Size size{static_cast<std::uint64_t>(dimensions[0]), static_cast<std::uint64_t>(dimensions[1]),
                    static_cast<std::uint64_t>(dimensions[2])};
    grid.cells.uniform_type = CellType::hexahedron;
    grid.cells.connectivity =
        grid.points.tuples() < (1u << 31) ? hexahedra<std::int32_t>(size) : hexahedra<std::int64_t>(size);
    notes.push_back(fmt::format("a structured grid of {} x {} x {} points was read as {} hexahedra", size.x, size.y,
                                size.z, grid.cells.count()));
    return grid;
}

} // namespace isotet::io::vtk
