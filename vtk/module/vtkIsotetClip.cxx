// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vtkIsotetClip.h"

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkUnstructuredGrid.h"

#include "arrays.hpp"
#include "block.hpp"
#include "fallback.hpp"
#include "leaves.hpp"
#include "ranks.hpp"
#include "run.hpp"
#include "unstructured.hpp"

vtkStandardNewMacro(vtkIsotetClip);

namespace
{

/// Empty where the values fit the side.
std::string WhyNoRange(const isotet_vtk::Wishes& wishes)
{
  if (wishes.solid == isotet_vtk::SolidWish::none)
  {
    return "a clip takes cells above, below or between values, but Solid is NO_SOLID";
  }
  const std::set<double> different(wishes.isovalues.begin(), wishes.isovalues.end());
  if (wishes.solid == isotet_vtk::SolidWish::between)
  {
    return different.size() < 2 ? "a clip between values takes two of them" : "";
  }
  return different.size() == 1 ? ""
                               : "a clip above or below takes one value, but there are " + std::to_string(different.size());
}

/// What one data set gives: an error, or nothing.
std::string ClipOne(vtkUnstructuredGrid* grid, vtkDataArray* scalars, const isotet_vtk::Wishes& wishes, bool polyhedra,
  const isotet::Run& run, vtkUnstructuredGrid* out, std::set<std::string>& reasons)
{
  isotet_vtk::Block block;
  if (const auto taken = block.take(grid, scalars, wishes); !taken)
  {
    return taken.error().message;
  }
  if (const auto types = block.cells().other_types(); !types.empty())
  {
    reasons.insert("cells of these types are left out: " + isotet_vtk::names_of(types));
  }
  if (!block.has_contoured())
  {
    return {};
  }
  const auto clipped = block.clip(polyhedra, run, out);
  reasons.insert(block.notes().begin(), block.notes().end());
  return clipped ? std::string() : clipped.error().message;
}

} // namespace

vtkIsotetClip::vtkIsotetClip()
{
  this->Solid = SOLID_ABOVE;
}

vtkSmartPointer<vtkDataSet> vtkIsotetClip::NewLeaf()
{
  return vtkSmartPointer<vtkUnstructuredGrid>::New();
}

int vtkIsotetClip::RequestData(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const isotet_vtk::Ranks ranks(this->Controller);
  vtkDataObject* const input = vtkDataObject::GetData(inputs[0], 0);
  const bool isAlone = vtkDataSet::SafeDownCast(input) != nullptr;
  isotet_vtk::Wishes wishes = this->MakeWishes();
  wishes.normals = false;
  if (!isAlone || ranks.count() > 1)
  {
    wishes.tolerance = 0;
  }
  isotet_vtk::AlgorithmRun run(this, this->NumberOfThreads);
  std::string error = WhyNoRange(wishes), missing;
  std::set<std::string> reasons;
  bool found = false;
  const vtkSmartPointer<vtkDataSet> kind = this->NewLeaf();
  const std::vector<isotet_vtk::Leaf> leaves =
    isotet_vtk::leaves_of(input, vtkDataObject::GetData(outputs, 0), kind);
  for (const isotet_vtk::Leaf& leaf : leaves)
  {
    if (leaf.data->GetNumberOfCells() == 0 || !error.empty())
    {
      continue;
    }
    const vtkSmartPointer<vtkUnstructuredGrid> grid = isotet_vtk::unstructured_of(leaf.data);
    vtkSmartPointer<vtkDataArray> scalars = this->FindArray({ leaf.index, grid, leaf.out }, isAlone, error, missing);
    if (!scalars)
    {
      continue;
    }
    found = true;
    if (scalars->GetNumberOfComponents() > 1)
    {
      scalars = isotet_vtk::component_of(scalars, this->ArrayComponent, scalars->GetName());
    }
    error = ClipOne(
      grid, scalars, wishes, this->Polyhedra != 0, run.run(), vtkUnstructuredGrid::SafeDownCast(leaf.out), reasons);
  }
  const isotet_vtk::Ranks::Flags all =
    ranks.any({ .failed = !error.empty(), .missing = !missing.empty(), .found = found });
  if (all.failed || (all.missing && !all.found))
  {
    error = ranks.first_error(all.failed ? error : missing);
    for (const isotet_vtk::Leaf& leaf : leaves)
    {
      leaf.out->Initialize();
    }
  }
  if (run.cancelled())
  {
    return 1; // VTK knows
  }
  if (!error.empty())
  {
    vtkErrorMacro(<< error);
    return 0;
  }
  return this->SayReasons(reasons);
}

void vtkIsotetClip::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Polyhedra: " << this->Polyhedra << "\n";
}
