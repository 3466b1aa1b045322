// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "golden/vtk_contour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <span>
#include <vector>

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkContour3DLinearGrid.h>
#include <vtkCutter.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPlane.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>
#include <vtkTriangleFilter.h>
#include <vtkUnstructuredGrid.h>

#include "grid/cells.hpp"

namespace isotet::test {

namespace {

template <class VtkArray>
void set_scalars(vtkUnstructuredGrid* out, const Array& field) {
    vtkNew<VtkArray> scalars;
    scalars->SetName("field");
    scalars->SetNumberOfTuples(static_cast<vtkIdType>(field.tuples()));
    for (std::size_t p = 0; p < field.tuples(); ++p)
        scalars->SetValue(static_cast<vtkIdType>(p), static_cast<typename VtkArray::ValueType>(field.at(p)));
    out->GetPointData()->SetScalars(scalars);
}

double area_of(vtkPolyData* surface) {
    double area = 0;
    vtkNew<vtkIdList> corners;
    for (vtkIdType t = 0; t < surface->GetNumberOfCells(); ++t) {
        surface->GetCellPoints(t, corners);
        double a[3], b[3], c[3];
        surface->GetPoint(corners->GetId(0), a);
        surface->GetPoint(corners->GetId(1), b);
        surface->GetPoint(corners->GetId(2), c);
        double square = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const int j = (axis + 1) % 3, k = (axis + 2) % 3;
            const double n = (b[j] - a[j]) * (c[k] - a[k]) - (b[k] - a[k]) * (c[j] - a[j]);
            square += n * n;
        }
        area += std::sqrt(square) / 2;
    }
    return area;
}

/// Types and corners of the cells, as VTK wants them.
class VtkCells {
public:
    explicit VtkCells(const Array& field) : field_(field) {}

    void add(int type, std::span<const std::uint64_t> corners) {
        std::vector<std::uint64_t> sorted(corners.begin(), corners.end());
        std::sort(sorted.begin(), sorted.end());
        const bool is_valid =
            std::none_of(corners.begin(), corners.end(), [&](std::uint64_t p) { return std::isnan(field_.at(p)); });
        if (!is_valid || !seen_.insert(sorted).second) return;
        std::vector<vtkIdType> ids(corners.begin(), corners.end());
        cells_->InsertNextCell(static_cast<vtkIdType>(ids.size()), ids.data());
        types_.push_back(type);
    }
    bool empty() const { return types_.empty(); }
    void give_to(vtkUnstructuredGrid* grid) { grid->SetCells(types_.data(), cells_); }

private:
    const Array& field_;
    std::set<std::vector<std::uint64_t>> seen_;
    std::vector<int> types_;
    vtkNew<vtkCellArray> cells_;
};

void add_cells(const Grid& grid, VtkCells& out) {
    const core::CellReader cells = core::CellReader::open(grid).value();
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        if (!core::is_contoured(cells.type(cell))) continue;
        std::vector<std::uint64_t> corners;
        for (int k = 0; k < core::corners_of(cells.type(cell)); ++k)
            corners.push_back(cells.corner(cells.first(cell) + static_cast<std::uint64_t>(k)));
        out.add(cells.type(cell), corners);
    }
}

} // namespace

namespace {

/// Nothing where no cell is left.
vtkSmartPointer<vtkUnstructuredGrid> vtk_grid_of(const Grid& grid, const Array& field, bool split_cells) {
    auto out = vtkSmartPointer<vtkUnstructuredGrid>::New();
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(static_cast<vtkIdType>(grid.points.tuples()));
    for (std::size_t p = 0; p < grid.points.tuples(); ++p)
        points->SetPoint(static_cast<vtkIdType>(p), grid.points.at(p, 0), grid.points.at(p, 1), grid.points.at(p, 2));
    out->SetPoints(points);
    if (field.type() == ScalarType::float32) set_scalars<vtkFloatArray>(out, field);
    else set_scalars<vtkDoubleArray>(out, field);

    VtkCells cells(field);
    if (split_cells)
        for (const auto& tet : split(grid).value().tets) cells.add(VTK_TETRA, tet);
    else add_cells(grid, cells);
    if (cells.empty()) return nullptr;
    cells.give_to(out);
    return out;
}

VtkSurface measured(vtkPolyData* output) {
    return {static_cast<std::uint64_t>(output->GetNumberOfPoints()),
            static_cast<std::uint64_t>(output->GetNumberOfCells()), area_of(output)};
}

} // namespace

VtkSurface vtk_contour(const Grid& grid, const Array& field, double isovalue, bool split_cells) {
    const auto input = vtk_grid_of(grid, field, split_cells);
    if (!input) return {};
    vtkNew<vtkContour3DLinearGrid> contour;
    contour->SetInputData(input);
    contour->SetMergePoints(true);
    contour->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
    contour->SetValue(0, isovalue);
    contour->Update();
    return measured(vtkPolyData::SafeDownCast(contour->GetOutputDataObject(0)));
}

VtkSurface vtk_cut(const Grid& grid, const Array& field, const Plane& plane) {
    const auto input = vtk_grid_of(grid, field, true);
    if (!input) return {};
    const auto& n = plane.normal;
    const double squares = n[0] * n[0] + n[1] * n[1] + n[2] * n[2], along = plane.offset / squares;
    vtkNew<vtkPlane> function;
    function->SetNormal(n[0], n[1], n[2]);
    function->SetOrigin(along * n[0], along * n[1], along * n[2]);
    vtkNew<vtkCutter> cutter;
    cutter->SetInputData(input);
    cutter->SetCutFunction(function);
    cutter->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
    cutter->Update();
    vtkNew<vtkTriangleFilter> triangles;
    triangles->SetInputData(cutter->GetOutput());
    triangles->Update();
    return measured(triangles->GetOutput());
}

} // namespace isotet::test
