// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fallback.hpp"

#include <algorithm>

#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>

#include <vtkAlgorithm.h>
#include <vtkAppendPolyData.h>
#include <vtkCellData.h>
#include <vtkContourFilter.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

#include "cells.hpp"
#include "vtkIsotetContourFilter.h"

namespace isotet_vtk {

std::string reason_against(vtkDataObject* data, vtkDataArray* scalars) {
    if (!vtkUnstructuredGrid::SafeDownCast(data))
        return std::string(data->GetClassName()) +
               " is contoured by vtkContourFilter: isotet contours vtkUnstructuredGrid";
    if (scalars && scalars->GetNumberOfComponents() != 1)
        return "array '" + std::string(scalars->GetName() ? scalars->GetName() : "") + "' has " +
               std::to_string(scalars->GetNumberOfComponents()) +
               " components and is contoured by vtkContourFilter: isotet contours scalars";
    return {};
}

std::string names_of(const std::vector<std::uint8_t>& types) {
    std::string names;
    for (const std::uint8_t type : types) names += (names.empty() ? "" : ", ") + isotet::name_of_cell_type(type);
    return names;
}

std::string reason_against(const std::vector<std::uint8_t>& types, const std::string& why_not) {
    const bool curved = std::any_of(types.begin(), types.end(), isotet::is_curved);
    return "cells of these types are contoured by vtkContourFilter, all others by isotet: " + names_of(types) +
           (curved && !why_not.empty() ? "; " + why_not : "");
}

namespace {

/// The data set with `scalars` among its point arrays: a component of an array is in none.
vtkSmartPointer<vtkDataSet> with_scalars(vtkDataSet* data, vtkDataArray* scalars) {
    vtkPointData* const arrays = data->GetPointData();
    for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
        if (arrays->GetAbstractArray(i) == scalars) return data;
    auto more = vtkSmartPointer<vtkDataSet>::Take(data->NewInstance());
    more->ShallowCopy(data);
    if (scalars->GetName() && *scalars->GetName()) more->GetPointData()->AddArray(scalars);
    else more->GetPointData()->SetScalars(scalars); // in the place of the active ones
    return more;
}

} // namespace

void contour_by_vtk(vtkDataSet* data, vtkDataArray* scalars, const Wishes& wishes, vtkPolyData* out) {
    const vtkIsotetContourFilter::Suspend suspend; // VTK's own, also where isotet takes its place
    vtkNew<vtkContourFilter> filter;
    filter->SetInputData(with_scalars(data, scalars));
    constexpr int points = vtkDataObject::FIELD_ASSOCIATION_POINTS;
    const bool has_name = scalars->GetName() && *scalars->GetName();
    if (has_name) filter->SetInputArrayToProcess(0, 0, 0, points, scalars->GetName());
    else filter->SetInputArrayToProcess(0, 0, 0, points, vtkDataSetAttributes::SCALARS);
    filter->SetNumberOfContours(static_cast<int>(wishes.isovalues.size()));
    for (std::size_t i = 0; i < wishes.isovalues.size(); ++i)
        filter->SetValue(static_cast<int>(i), wishes.isovalues[i]);
    filter->SetComputeNormals(wishes.normals);
    filter->SetComputeScalars(wishes.scalars && (has_name || !scalars->GetName()));
    filter->SetGenerateTriangles(wishes.triangles);
    filter->SetArrayComponent(wishes.component);
    if (wishes.points)
        filter->SetOutputPointsPrecision(*wishes.points == isotet::Precision::float32 ? vtkAlgorithm::SINGLE_PRECISION
                                                                                      : vtkAlgorithm::DOUBLE_PRECISION);
    filter->Update();
    out->ShallowCopy(filter->GetOutput());
}

vtkSmartPointer<vtkUnstructuredGrid> cells_of_types(vtkUnstructuredGrid* grid, const std::vector<std::uint8_t>& types) {
    auto others = vtkSmartPointer<vtkUnstructuredGrid>::New();
    others->SetPoints(grid->GetPoints());
    others->GetPointData()->ShallowCopy(grid->GetPointData());
    others->GetCellData()->CopyAllOn();
    others->GetCellData()->CopyAllocate(grid->GetCellData());
    others->Allocate();
    vtkUnsignedCharArray* const ghosts = grid->GetCellGhostArray();
    vtkNew<vtkIdList> points;
    for (vtkIdType cell = 0; cell < grid->GetNumberOfCells(); ++cell) {
        const int type = grid->GetCellType(cell);
        if (std::find(types.begin(), types.end(), type) == types.end()) continue;
        if (ghosts && (ghosts->GetValue(cell) & ghost_bits)) continue;
        grid->GetCellPoints(cell, points);
        others->GetCellData()->CopyData(grid->GetCellData(), cell, others->InsertNextCell(type, points));
    }
    return others;
}

void append(vtkPolyData* more, vtkPolyData* out) {
    if (more->GetNumberOfCells() == 0) return;
    if (out->GetNumberOfCells() == 0) {
        out->ShallowCopy(more);
        return;
    }
    vtkNew<vtkAppendPolyData> both;
    both->AddInputData(out);
    both->AddInputData(more);
    both->Update();
    out->ShallowCopy(both->GetOutput());
}

} // namespace isotet_vtk
