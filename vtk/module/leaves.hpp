// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The data sets of a filter's input, one by one, and what its output has for each.
#pragma once

#include <vector>

#include <vtkSmartPointer.h>

class vtkDataObject;
class vtkDataSet;

namespace isotet_vtk {

/// A data set that is no composite one, and where its result goes.
struct Leaf {
    unsigned int index = 0; ///< of the data set in its composite one: the same over time
    vtkDataSet* data = nullptr;
    vtkSmartPointer<vtkDataSet> out;
};

/// What a filter gives for `input`: a tree as that of the input, a list of blocks for other composite data, else
/// `alone`.
vtkSmartPointer<vtkDataObject> output_for(vtkDataObject* input, vtkDataSet* alone);

/// The data sets of `input`; the output is given a new instance of `kind` for each.
std::vector<Leaf> leaves_of(vtkDataObject* input, vtkDataObject* output, vtkDataSet* kind);

} // namespace isotet_vtk
