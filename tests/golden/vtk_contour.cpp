// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "golden/vtk_contour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkContour3DLinearGrid.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

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

} // namespace

VtkSurface vtk_contour(const Grid& grid, const Array& field, double isovalue) {
    vtkNew<vtkUnstructuredGrid> input;
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(static_cast<vtkIdType>(grid.points.tuples()));
    for (std::size_t p = 0; p < grid.points.tuples(); ++p)
        points->SetPoint(static_cast<vtkIdType>(p), grid.points.at(p, 0), grid.points.at(p, 1), grid.points.at(p, 2));
    input->SetPoints(points);
    if (field.type() == ScalarType::float32) set_scalars<vtkFloatArray>(input, field);
    else set_scalars<vtkDoubleArray>(input, field);

    const TetList list = split(grid).value();
    vtkNew<vtkCellArray> cells;
    std::set<std::array<std::uint64_t, 4>> seen;
    for (const auto& tet : list.tets) {
        auto sorted = tet;
        std::sort(sorted.begin(), sorted.end());
        const bool is_valid =
            std::none_of(tet.begin(), tet.end(), [&](std::uint64_t p) { return std::isnan(field.at(p)); });
        if (!is_valid || !seen.insert(sorted).second) continue;
        const vtkIdType corners[4] = {static_cast<vtkIdType>(tet[0]), static_cast<vtkIdType>(tet[1]),
                                      static_cast<vtkIdType>(tet[2]), static_cast<vtkIdType>(tet[3])};
        cells->InsertNextCell(4, corners);
    }
    if (seen.empty()) return {};
    input->SetCells(VTK_TETRA, cells);

    vtkNew<vtkContour3DLinearGrid> contour;
    contour->SetInputData(input);
    contour->SetMergePoints(true);
    contour->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
    contour->SetValue(0, isovalue);
    contour->Update();
    vtkPolyData* output = vtkPolyData::SafeDownCast(contour->GetOutputDataObject(0));
    return {static_cast<std::uint64_t>(output->GetNumberOfPoints()),
            static_cast<std::uint64_t>(output->GetNumberOfCells()), area_of(output)};
}

} // namespace isotet::test
