// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "polydata.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnstructuredGrid.h>

#include "arrays.hpp"

namespace isotet_vtk {

namespace {

isotet::Array as_float32(const isotet::Array& values) {
    std::vector<float> out(values.size());
    std::ranges::transform(values.as<double>(), out.begin(), [](double value) { return static_cast<float>(value); });
    return isotet::Array::own(std::move(out), values.components());
}

isotet::Array as_float64(const isotet::Array& values) {
    const auto from = values.as<float>();
    return isotet::Array::own(std::vector<double>(from.begin(), from.end()), values.components());
}

/// Triangles in memory that VTK shares. `Values` is the array of VTK for their integers, or signed ones as wide.
template <class Values>
void set_triangles(vtkCellArray* cells, const isotet::Array& triangles) {
    using Index = typename Values::ValueType;
    vtkNew<Values> corners, offsets;
    const auto count = static_cast<vtkIdType>(triangles.tuples());
    lend(corners, isotet::Array(isotet::scalar_type_of<Index>(), triangles.data(), triangles.size(), 1,
                                triangles.owner().lock()));
    offsets->SetNumberOfValues(count + 1);
    Index* const first = offsets->GetPointer(0);
    for (vtkIdType t = 0; t <= count; ++t) first[t] = static_cast<Index>(3 * t);
    cells->SetData(offsets, corners);
}

/// Numbers of vertices below 2^31 are the same bytes in signed and unsigned integers.
vtkSmartPointer<vtkCellArray> triangles_of(const isotet::Surface& surface) {
    auto cells = vtkSmartPointer<vtkCellArray>::New();
    isotet::Array triangles = surface.triangles;
    constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
    if (triangles.type() != isotet::ScalarType::uint32) {
        set_triangles<vtkTypeInt64Array>(cells, triangles);
    } else if (surface.vertex_count() <= most && triangles.size() <= most) {
        set_triangles<vtkTypeInt32Array>(cells, triangles);
    } else {
        const auto narrow = triangles.as<std::uint32_t>();
        triangles = isotet::Array::own(std::vector<std::int64_t>(narrow.begin(), narrow.end()), 3);
        set_triangles<vtkTypeInt64Array>(cells, triangles);
    }
    return cells;
}

/// The contoured scalars: the isovalue of each point, in the array's type.
vtkSmartPointer<vtkDataArray> isovalues_of(const std::vector<isotet::Surface>& surfaces, const Wishes& wishes,
                                           vtkDataArray* scalars) {
    std::vector<double> values;
    for (std::size_t i = 0; i < surfaces.size(); ++i)
        values.insert(values.end(), surfaces[i].vertex_count(), wishes.isovalues[i]);
    const isotet::Array all = isotet::Array::own(std::move(values));
    switch (scalars->GetDataType()) {
    case VTK_FLOAT: return to_vtk(as_float32(all), scalars->GetName());
    case VTK_DOUBLE: return to_vtk(all, scalars->GetName());
    default: return rounded_to(scalars->GetDataType(), all, scalars->GetName());
    }
}

/// A carried point field in the type that `like` has: interpolated integers are rounded.
vtkSmartPointer<vtkDataArray> carried(const isotet::Field& field, vtkDataArray* like) {
    const int type = like ? like->GetDataType() : VTK_DOUBLE;
    const bool is_double = field.values.type() == isotet::ScalarType::float64;
    if (type == VTK_FLOAT && is_double) return to_vtk(as_float32(field.values), field.name.c_str());
    if (type == VTK_FLOAT || type == VTK_DOUBLE || !is_double) return to_vtk(field.values, field.name.c_str());
    return rounded_to(type, field.values, field.name.c_str());
}

void add_fields(const std::vector<isotet::Field>& of_points, const std::vector<isotet::Field>& of_cells,
                vtkDataSet* from, vtkDataSet* to) {
    for (const isotet::Field& field : of_points)
        to->GetPointData()->AddArray(carried(field, from->GetPointData()->GetArray(field.name.c_str())));
    for (const isotet::Field& field : of_cells) to->GetCellData()->AddArray(to_vtk(field.values, field.name.c_str()));
}

void keep_active(vtkDataSetAttributes* from, vtkDataSetAttributes* to) {
    for (int attribute = 0; attribute < vtkDataSetAttributes::NUM_ATTRIBUTES; ++attribute) {
        vtkAbstractArray* const active = from->GetAbstractAttribute(attribute);
        if (active && active->GetName() && to->HasArray(active->GetName()) && !to->GetAbstractAttribute(attribute))
            to->SetActiveAttribute(active->GetName(), attribute);
    }
}

/// Vectors stay the active vectors, and so on.
void keep_active(vtkDataSet* from, vtkDataSet* to) {
    keep_active(from->GetPointData(), to->GetPointData());
    keep_active(from->GetCellData(), to->GetCellData());
}

} // namespace

isotet::Array in_precision(const isotet::Array& positions, const Wishes& wishes) {
    const bool is_single = positions.type() == isotet::ScalarType::float32;
    if (!wishes.points || is_single == (*wishes.points == isotet::Precision::float32)) return positions;
    return is_single ? as_float64(positions) : as_float32(positions);
}

void write_fields(const std::vector<isotet::Field>& of_points, const std::vector<isotet::Field>& of_cells,
                  vtkDataSet* from, vtkDataSet* to) {
    add_fields(of_points, of_cells, from, to);
    keep_active(from, to);
}

void write_polydata(const std::vector<isotet::Surface>& surfaces, const Wishes& wishes, vtkDataArray* scalars,
                    vtkUnstructuredGrid* grid, vtkPolyData* out) {
    const isotet::Surface surface = surfaces.size() == 1 ? surfaces[0] : isotet::join(surfaces, {});
    vtkNew<vtkPoints> points;
    points->SetData(to_vtk(in_precision(surface.positions, wishes), "Points"));
    out->SetPoints(points);
    out->SetPolys(triangles_of(surface));
    vtkPointData* const of_points = out->GetPointData();
    const bool is_component = scalars->GetName() && !*scalars->GetName(); // the first one, which VTK gives no array
    if (wishes.scalars && !is_component) of_points->SetScalars(isovalues_of(surfaces, wishes, scalars));
    add_fields(surface.point_fields, surface.cell_fields, grid, out);
    if (wishes.normals && isotet::are_of_vertices(surface.normals_kind))
        of_points->SetNormals(to_vtk(surface.normals, "Normals"));
    keep_active(grid, out);
}

} // namespace isotet_vtk
