// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// An implicit function of VTK as a field, whose isosurfaces are cuts.
#pragma once

#include <array>
#include <string>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include <vtkSmartPointer.h>

class vtkDataArray;
class vtkDataSet;
class vtkImplicitFunction;

namespace isotet_vtk {

/// The name of the array that cut_field() makes.
inline constexpr const char* cut_name = "isotet cut";

/// How a function is evaluated. Of a plane the products of its unit normal and the points, which are the same wherever it
/// moves along its normal; of a sphere or cylinder distances from its middle; of others its values.
struct Cut {
    enum class Kind { plane, distance, values } kind = Kind::values;
    std::array<double, 3> normal{}; ///< of a plane
    double radius = 0;              ///< of a sphere or cylinder
    double isovalue = 0;            ///< of the field, where the function is 0
};

Cut cut_of(vtkImplicitFunction* function);

/// One value a point of `data`, in double.
/// Errors   as slice_field()
isotet::Result<vtkSmartPointer<vtkDataArray>> cut_field(vtkDataSet* data, vtkImplicitFunction* function, const Cut& cut,
                                                        const isotet::Run& run);

} // namespace isotet_vtk
