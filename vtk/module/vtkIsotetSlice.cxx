// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vtkIsotetSlice.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkImplicitFunction.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"

#include "cut.hpp"
#include "leaves.hpp"
#include "run.hpp"
#include "wishes.hpp"

vtkStandardNewMacro(vtkIsotetSlice);
vtkCxxSetObjectMacro(vtkIsotetSlice, CutFunction, vtkImplicitFunction);

/// Fields of the blocks, kept while neither the points nor what is cut along is another.
struct vtkIsotetSlice::Cuts
{
  struct Field
  {
    vtkMTimeType Points = 0, Function = 0;
    std::array<double, 3> Normal{};
    vtkSmartPointer<vtkDataArray> Values;
  };
  isotet_vtk::Cut Cut;
  std::map<unsigned int, Field> Fields, Used;
};

vtkIsotetSlice::vtkIsotetSlice()
  : Kept(std::make_unique<Cuts>())
{
}

vtkIsotetSlice::~vtkIsotetSlice()
{
  this->SetCutFunction(nullptr);
}

vtkMTimeType vtkIsotetSlice::GetMTime()
{
  const vtkMTimeType time = this->Superclass::GetMTime();
  return this->CutFunction ? std::max(time, this->CutFunction->GetMTime()) : time;
}

isotet_vtk::Wishes vtkIsotetSlice::MakeWishes()
{
  isotet_vtk::Wishes wishes = this->Superclass::MakeWishes();
  wishes.normals = wishes.scalars = false;
  wishes.refines_carried = true;
  wishes.solid = isotet_vtk::SolidWish::none;
  wishes.component = 0;
  if (this->CutFunction)
  {
    this->Kept->Cut = isotet_vtk::cut_of(this->CutFunction);
  }
  for (double& value : wishes.isovalues)
  {
    value += this->Kept->Cut.isovalue;
  }
  return wishes;
}

vtkDataArray* vtkIsotetSlice::FindArray(const isotet_vtk::Leaf& leaf, bool, std::string& error, std::string&)
{
  if (!this->CutFunction)
  {
    error = "there is no CutFunction to cut along";
    return nullptr;
  }
  const isotet_vtk::Cut& cut = this->Kept->Cut;
  const bool isPlane = cut.kind == isotet_vtk::Cut::Kind::plane;
  auto* const set = vtkPointSet::SafeDownCast(leaf.data);
  const vtkMTimeType points = set && set->GetPoints() ? set->GetPoints()->GetData()->GetMTime() : leaf.data->GetMTime();
  const vtkMTimeType function = isPlane ? 0 : this->CutFunction->GetMTime();
  Cuts::Field field = this->Kept->Fields[leaf.index];
  if (!field.Values || field.Points != points || field.Function != function || field.Normal != cut.normal)
  {
    isotet_vtk::AlgorithmRun run(this, this->NumberOfThreads);
    auto values = isotet_vtk::cut_field(leaf.data, this->CutFunction, cut, run.run());
    if (!values)
    {
      error = values.error().message;
      return nullptr;
    }
    field = { points, function, cut.normal, *values };
  }
  this->Kept->Used[leaf.index] = field;
  return field.Values;
}

int vtkIsotetSlice::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const int done = this->Superclass::RequestData(request, inputs, outputs);
  this->Kept->Fields = std::move(this->Kept->Used); // those of blocks that are gone go
  this->Kept->Used.clear();
  vtkDataObject* const output = vtkDataObject::GetData(outputs, 0);
  const auto forget = [](vtkDataObject* data) { // VTK carries the field
    if (auto* const set = vtkDataSet::SafeDownCast(data))
    {
      set->GetPointData()->RemoveArray(isotet_vtk::cut_name);
    }
  };
  forget(output);
  if (auto* const composite = vtkCompositeDataSet::SafeDownCast(output))
  {
    auto it = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
    for (it->InitTraversal(); !it->IsDoneWithTraversal(); it->GoToNextItem())
    {
      forget(it->GetCurrentDataObject());
    }
  }
  return done;
}

void vtkIsotetSlice::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "CutFunction: " << this->CutFunction << "\n";
}
