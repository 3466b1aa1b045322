// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "leaves.hpp"

#include <vtkCompositeDataIterator.h>
#include <vtkDataObjectTree.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkMultiBlockDataSet.h>

namespace isotet_vtk {

vtkSmartPointer<vtkDataObject> output_for(vtkDataObject* input, vtkDataSet* alone) {
    if (vtkDataObjectTree::SafeDownCast(input)) return vtkSmartPointer<vtkDataObject>::Take(input->NewInstance());
    if (vtkCompositeDataSet::SafeDownCast(input)) return vtkSmartPointer<vtkMultiBlockDataSet>::New();
    return alone;
}

std::vector<Leaf> leaves_of(vtkDataObject* input, vtkDataObject* output, vtkDataSet* kind) {
    if (auto* const data = vtkDataSet::SafeDownCast(input)) return {{0, data, vtkDataSet::SafeDownCast(output)}};
    std::vector<Leaf> leaves;
    auto* const composite = vtkCompositeDataSet::SafeDownCast(input);
    if (!composite) return leaves;
    auto* const tree = vtkDataObjectTree::SafeDownCast(output);
    auto* const list = vtkMultiBlockDataSet::SafeDownCast(output);
    const bool is_tree = vtkDataObjectTree::SafeDownCast(input) != nullptr;
    if (is_tree) tree->CopyStructure(composite);
    auto it = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem()) {
        auto* const data = vtkDataSet::SafeDownCast(it->GetCurrentDataObject());
        if (!data) continue;
        Leaf leaf{it->GetCurrentFlatIndex(), data, vtkSmartPointer<vtkDataSet>::Take(kind->NewInstance())};
        leaf.out->GetFieldData()->PassData(data->GetFieldData());
        if (is_tree) tree->SetDataSet(it, leaf.out);
        else list->SetBlock(list->GetNumberOfBlocks(), leaf.out);
        leaves.push_back(leaf);
    }
    return leaves;
}

} // namespace isotet_vtk
