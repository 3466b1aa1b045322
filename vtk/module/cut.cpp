// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cut.hpp"

#include <algorithm>
#include <cmath>

#include <isotet/slice.hpp>

#include <vtkCylinder.h>
#include <vtkDataSet.h>
#include <vtkDoubleArray.h>
#include <vtkPlane.h>
#include <vtkPointSet.h>
#include <vtkPoints.h>
#include <vtkSphere.h>

#include "arrays.hpp"

namespace isotet_vtk {

Cut cut_of(vtkImplicitFunction* function) {
    Cut cut;
    if (auto* const plane = vtkPlane::SafeDownCast(function); plane && !plane->GetTransform()) {
        cut.kind = Cut::Kind::plane;
        plane->GetNormal(cut.normal.data());
        const double length = std::hypot(cut.normal[0], cut.normal[1], cut.normal[2]);
        if (length > 0)
            for (double& x : cut.normal) x /= length;
        // Subclasses shift planes: their origin alone does not tell where they are.
        cut.isovalue = length > 0 ? -plane->FunctionValue(0, 0, 0) / length : 0;
    } else if (auto* const sphere = vtkSphere::SafeDownCast(function)) {
        cut.kind = Cut::Kind::distance;
        cut.radius = cut.isovalue = std::abs(sphere->GetRadius());
    } else if (auto* const cylinder = vtkCylinder::SafeDownCast(function)) {
        cut.kind = Cut::Kind::distance;
        cut.radius = cut.isovalue = std::abs(cylinder->GetRadius());
    }
    return cut;
}

namespace {

isotet::Result<vtkSmartPointer<vtkDataArray>> along_normal(vtkDataArray* points, const Cut& cut,
                                                           const isotet::Run& run) {
    SharedArray shared;
    auto field = isotet::slice_field(shared.of(points), isotet::Plane{cut.normal, 0}, run);
    if (!field) return field.error();
    return to_vtk(field->values, cut_name);
}

double value_at(std::array<double, 3>& place, vtkImplicitFunction* function, const Cut& cut) {
    if (cut.kind == Cut::Kind::plane)
        return cut.normal[0] * place[0] + cut.normal[1] * place[1] + cut.normal[2] * place[2];
    const double value = function->FunctionValue(place.data());
    return cut.kind == Cut::Kind::values ? value : std::sqrt(std::max(value + cut.radius * cut.radius, 0.0));
}

vtkSmartPointer<vtkDataArray> values_of(vtkDataSet* data, vtkImplicitFunction* function, const Cut& cut) {
    auto values = vtkSmartPointer<vtkDoubleArray>::New();
    values->SetName(cut_name);
    values->SetNumberOfTuples(data->GetNumberOfPoints());
    for (vtkIdType p = 0; p < data->GetNumberOfPoints(); ++p) {
        std::array<double, 3> place{};
        data->GetPoint(p, place.data());
        values->SetValue(p, value_at(place, function, cut));
    }
    return values;
}

} // namespace

isotet::Result<vtkSmartPointer<vtkDataArray>> cut_field(vtkDataSet* data, vtkImplicitFunction* function, const Cut& cut,
                                                        const isotet::Run& run) {
    auto* const set = vtkPointSet::SafeDownCast(data);
    if (cut.kind == Cut::Kind::plane && set && set->GetPoints())
        return along_normal(set->GetPoints()->GetData(), cut, run);
    return values_of(data, function, cut);
}

} // namespace isotet_vtk
