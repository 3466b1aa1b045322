// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Arrays of VTK as isotet::Array, and back, without copying them.
#pragma once

#include <memory>
#include <optional>

#include <isotet/array.hpp>

#include <vtkDataArray.h>
#include <vtkSmartPointer.h>

namespace isotet_vtk {

/// The scalar type of one of VTK's; nothing for strings and bits.
std::optional<isotet::ScalarType> scalar_type(vtkDataArray* array);

/// One array of a grid, over all executions of a filter: while VTK's modified time stays, the shared array has the same
/// owner, by which a session knows it again.
class SharedArray {
public:
    /// The memory of `array`, shared; copied where it is no plain memory, or is of bits. Empty for a null pointer.
    const isotet::Array& of(vtkDataArray* array);

    /// What the last of() returned.
    const isotet::Array& last() const { return array_; }

    /// Whether the last of() had another array, or one that was modified.
    bool changed() const { return changed_; }

    /// Lets go of VTK's array: until the next of() its memory must not be read.
    void release();

private:
    struct Owner {
        vtkSmartPointer<vtkDataArray> array;
    };
    std::shared_ptr<Owner> owner_;
    isotet::Array array_;
    vtkMTimeType time_ = 0;
    bool changed_ = true;
};

/// Gives the memory of `values` to `array`, an array of VTK of the same type, without a copy.
void lend(vtkDataArray* array, const isotet::Array& values);

/// `values` as an array of VTK, shared.
vtkSmartPointer<vtkDataArray> to_vtk(const isotet::Array& values, const char* name);

/// Numbers rounded to the integers of one of VTK's types, within its limits.
vtkSmartPointer<vtkDataArray> rounded_to(int vtk_type, const isotet::Array& values, const char* name);

/// One component of an array, in an array of its own with the name `name`.
vtkSmartPointer<vtkDataArray> component_of(vtkDataArray* array, int component, const char* name);

} // namespace isotet_vtk
