// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vtkIsotetContour.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "vtkCellData.h"
#include "vtkContourValues.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnstructuredGrid.h"

#include "arrays.hpp"
#include "blocks.hpp"
#include "fallback.hpp"
#include "leaves.hpp"
#include "run.hpp"

vtkStandardNewMacro(vtkIsotetContour);
vtkCxxSetObjectMacro(vtkIsotetContour, Controller, vtkMultiProcessController);

namespace
{

using isotet_vtk::BlockTask;
using isotet_vtk::Leaf;

/// What is contoured by whom.
struct Work
{
  std::vector<BlockTask> Tasks;
  std::vector<std::pair<Leaf, vtkDataArray*>> ForVtk;
  std::set<std::string> Reasons; ///< why VTK contours
  std::string Error;
  std::string Missing; ///< of blocks without the array: an error if no block of any rank has it
};

/// Why there are no scalars to contour.
std::string WhyThereIsNone(vtkAlgorithm* algorithm, vtkDataSet* data)
{
  vtkInformation* const asked = algorithm->GetInputArrayInformation(0);
  const char* const name = asked->Get(vtkDataObject::FIELD_NAME());
  if (!name)
  {
    return "there is no array to process: the point data have no active scalars";
  }
  if (!*name)
  {
    return "no array was chosen";
  }
  std::string text = "there is no array to process: no point array is called '" + std::string(name) + "'";
  if (data->GetCellData()->HasArray(name))
  {
    text += ", but a cell array is: use vtkCellDataToPointData before, in ParaView Cell Data to Point Data";
  }
  return text;
}

/// Empty where a solid can be made.
std::string WhyNoSolid(const Work& work, const isotet_vtk::Wishes& wishes)
{
  if (!work.Reasons.empty())
  {
    return "a Solid was asked for, but " + *work.Reasons.begin();
  }
  const auto different = std::set<double>(wishes.isovalues.begin(), wishes.isovalues.end()).size();
  if (wishes.solid == isotet_vtk::SolidWish::between && different < 2)
  {
    return "a Solid between values takes two of them";
  }
  return {};
}

} // namespace

struct vtkIsotetContour::Internals
{
  isotet_vtk::Blocks Blocks;

  /// A component of an array, and which array it was copied from.
  struct Component
  {
    vtkDataArray* From = nullptr;
    vtkMTimeType Time = 0;
    int Number = 0;
    vtkSmartPointer<vtkDataArray> Array;
  };
  std::map<unsigned int, Component> Components; ///< of the blocks of the last execution

  /// The array itself where it has one component.
  vtkDataArray* ComponentOf(
    unsigned int index, vtkDataArray* array, int number, std::map<unsigned int, Component>& kept)
  {
    if (array->GetNumberOfComponents() == 1)
    {
      return array;
    }
    Component component = this->Components[index];
    if (component.From != array || component.Time != array->GetMTime() || component.Number != number)
    {
      const char* const of = array->GetName();
      std::string name;
      if (number != 0)
      {
        name = of ? of : "";
        name += '_';
        name += std::to_string(number);
      }
      component = { array, array->GetMTime(), number, isotet_vtk::component_of(array, number, name.c_str()) };
    }
    kept[index] = component;
    return component.Array;
  }

  std::set<std::string> Warned; ///< in the last execution: a slider does not repeat warnings
};

//------------------------------------------------------------------------------
vtkIsotetContour::vtkIsotetContour()
  : ContourValues(vtkContourValues::New())
  , Internal(std::make_unique<Internals>())
{
  this->SetController(vtkMultiProcessController::GetGlobalController());
  this->SetInputArrayToProcess(
    0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, vtkDataSetAttributes::SCALARS);
}

vtkIsotetContour::~vtkIsotetContour()
{
  this->SetController(nullptr);
  this->ContourValues->Delete();
}

//------------------------------------------------------------------------------
void vtkIsotetContour::SetValue(int i, double value)
{
  this->ContourValues->SetValue(i, value);
}

double vtkIsotetContour::GetValue(int i)
{
  return this->ContourValues->GetValue(i);
}

double* vtkIsotetContour::GetValues()
{
  return this->ContourValues->GetValues();
}

void vtkIsotetContour::GetValues(double* contourValues)
{
  this->ContourValues->GetValues(contourValues);
}

void vtkIsotetContour::SetNumberOfContours(int number)
{
  this->ContourValues->SetNumberOfContours(number);
}

vtkIdType vtkIsotetContour::GetNumberOfContours()
{
  return this->ContourValues->GetNumberOfContours();
}

void vtkIsotetContour::GenerateValues(int numContours, double range[2])
{
  this->ContourValues->GenerateValues(numContours, range);
}

void vtkIsotetContour::GenerateValues(int numContours, double rangeStart, double rangeEnd)
{
  this->ContourValues->GenerateValues(numContours, rangeStart, rangeEnd);
}

void vtkIsotetContour::SetInputArray(const std::string& name)
{
  this->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, name.c_str());
}

vtkMTimeType vtkIsotetContour::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->ContourValues->GetMTime());
}

int vtkIsotetContour::GetLastUpdate()
{
  return static_cast<int>(this->Internal->Blocks.update());
}

bool vtkIsotetContour::GetUsedPackedGrids()
{
  return this->Internal->Blocks.all_packed();
}

vtkTypeInt64 vtkIsotetContour::GetPackedBytes()
{
  return static_cast<vtkTypeInt64>(this->Internal->Blocks.packed_bytes());
}

double vtkIsotetContour::GetFieldBound()
{
  return this->Internal->Blocks.field_bound();
}

double vtkIsotetContour::GetExtractSeconds()
{
  return this->Internal->Blocks.extract_seconds();
}

//------------------------------------------------------------------------------
int vtkIsotetContour::FillInputPortInformation(int, vtkInformation* info)
{
  // Composite data sets are taken whole: the executive must not come once a block.
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  return 1;
}

int vtkIsotetContour::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataObject");
  return 1;
}

vtkTypeBool vtkIsotetContour::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (request->Has(vtkDemandDrivenPipeline::REQUEST_DATA_OBJECT()))
  {
    return this->RequestDataObject(request, inputs, outputs);
  }
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

int vtkIsotetContour::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const vtkSmartPointer<vtkDataSet> alone = this->NewLeaf();
  const vtkSmartPointer<vtkDataObject> wanted =
    isotet_vtk::output_for(vtkDataObject::GetData(inputs[0], 0), alone);
  vtkDataObject* const output = vtkDataObject::GetData(outputs, 0);
  if (!output || output->GetDataObjectType() != wanted->GetDataObjectType())
  {
    outputs->GetInformationObject(0)->Set(vtkDataObject::DATA_OBJECT(), wanted);
  }
  return 1;
}

int vtkIsotetContour::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* const input = inputs[0]->GetInformationObject(0);
  vtkInformation* const output = outputs->GetInformationObject(0);
  if (!input || !this->NeedsGhosts() || output->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) < 2)
  {
    return 1;
  }
  // Gradients are sums over the cells around a point; of solids, faces where pieces meet are no boundary.
  const int levels = output->Get(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS());
  input->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), std::max(levels, 1));
  return 1;
}

//------------------------------------------------------------------------------
isotet_vtk::Wishes vtkIsotetContour::MakeWishes()
{
  isotet_vtk::Wishes wishes;
  wishes.isovalues.assign(this->GetValues(), this->GetValues() + this->GetNumberOfContours());
  wishes.normals = this->ComputeNormals;
  wishes.scalars = this->ComputeScalars;
  wishes.tolerance = this->Tolerance;
  wishes.expected_surfaces = static_cast<std::uint64_t>(this->ExpectedSurfaces);
  if (this->OutputPointsPrecision != DEFAULT_PRECISION)
  {
    wishes.points = this->OutputPointsPrecision == SINGLE_PRECISION ? isotet::Precision::float32
                                                                    : isotet::Precision::float64;
  }
  wishes.triangles = this->GenerateTriangles;
  wishes.component = this->ArrayComponent;
  wishes.solid = static_cast<isotet_vtk::SolidWish>(this->Solid);

  return wishes;
}

vtkDataArray* vtkIsotetContour::FindArray(
  const Leaf& leaf, bool isAlone, std::string& error, std::string& missing)
{
  int association = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  vtkDataArray* const scalars = this->GetInputArrayToProcess(0, leaf.data, association);
  if (!scalars) // blocks need not all have the array
  {
    (isAlone ? error : missing) = WhyThereIsNone(this, leaf.data);
  }
  else if (association != vtkDataObject::FIELD_ASSOCIATION_POINTS)
  {
    error = "the array to process is of cells, but isosurfaces are of point data: use vtkCellDataToPointData before, in "
            "ParaView Cell Data to Point Data";
  }
  else if (this->ArrayComponent >= scalars->GetNumberOfComponents() && scalars->GetNumberOfComponents() > 1)
  {
    error = "the array has " + std::to_string(scalars->GetNumberOfComponents()) +
      " components, but ArrayComponent is " + std::to_string(this->ArrayComponent);
  }
  else
  {
    return scalars;
  }
  return nullptr;
}

vtkSmartPointer<vtkDataSet> vtkIsotetContour::NewLeaf()
{
  return vtkSmartPointer<vtkPolyData>::New();
}

bool vtkIsotetContour::NeedsGhosts() const
{
  return this->ComputeNormals || this->Solid != NO_SOLID;
}

int vtkIsotetContour::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const isotet_vtk::Wishes wishes = this->MakeWishes();
  vtkDataObject* const input = vtkDataObject::GetData(inputs[0], 0);
  const bool isSolid = wishes.solid != isotet_vtk::SolidWish::none;
  const bool isAlone = vtkDataSet::SafeDownCast(input) != nullptr;
  Work work;
  std::map<unsigned int, Internals::Component> components;
  const vtkSmartPointer<vtkDataSet> kind = this->NewLeaf();
  for (const Leaf& leaf : isotet_vtk::leaves_of(input, vtkDataObject::GetData(outputs, 0), kind))
  {
    if (leaf.data->GetNumberOfCells() == 0)
    {
      continue;
    }
    vtkDataArray* const scalars = this->FindArray(leaf, isAlone, work.Error, work.Missing);
    if (!scalars)
    {
      continue;
    }
    auto* const grid = vtkUnstructuredGrid::SafeDownCast(leaf.data);
    vtkDataArray* const one =
      grid ? this->Internal->ComponentOf(leaf.index, scalars, this->ArrayComponent, components) : scalars;
    const std::string reason = this->GenerateTriangles
      ? isotet_vtk::reason_against(leaf.data, grid ? one : nullptr)
      : "GenerateTriangles is off: vtkContourFilter contours, and makes polygons";
    if (reason.empty())
    {
      work.Tasks.push_back({ leaf.index, grid, one, vtkPolyData::SafeDownCast(leaf.out) });
    }
    else
    {
      work.ForVtk.push_back({ leaf, scalars });
      work.Reasons.insert(reason);
    }
  }

  this->Internal->Components = std::move(components);

  isotet_vtk::AlgorithmRun run(this, this->NumberOfThreads);
  const isotet_vtk::Ranks ranks(this->Controller);
  if (isSolid && work.Error.empty())
  {
    work.Error = WhyNoSolid(work, wishes);
  }
  isotet_vtk::Blocks& blocks = this->Internal->Blocks;
  const bool found = !work.Tasks.empty() || !work.ForVtk.empty();
  const std::string error =
    blocks.contour(work.Tasks, wishes, ranks, run.run(), { work.Error, work.Missing, found, !isAlone });
  if (run.cancelled())
  {
    return 1; // VTK knows
  }
  if (!error.empty())
  {
    vtkErrorMacro(<< error);
    return 0;
  }
  for (const BlockTask& task : work.Tasks)
  {
    if (isSolid && !blocks.other_types(task.index).empty())
    {
      work.Reasons.insert("cells that isotet does not contour are no part of the solid");
    }
  }
  for (const auto& [leaf, scalars] : work.ForVtk)
  {
    isotet_vtk::contour_by_vtk(leaf.data, scalars, wishes, vtkPolyData::SafeDownCast(leaf.out));
  }
  for (const BlockTask& task : work.Tasks)
  {
    const std::vector<std::uint8_t> types = blocks.other_types(task.index);
    if (types.empty() || isSolid)
    {
      continue;
    }
    const char* const whyNot = this->Tolerance > 0
      ? "a Tolerance refines those of one grid on one rank, but for pyramids of any degree"
      : "a Tolerance above 0 refines curved ones";
    work.Reasons.insert(isotet_vtk::reason_against(types, whyNot));
    vtkNew<vtkPolyData> others;
    isotet_vtk::contour_by_vtk(isotet_vtk::cells_of_types(task.grid, types), task.scalars, wishes, others);
    isotet_vtk::append(others, task.out);
  }
  work.Reasons.insert(blocks.notes().begin(), blocks.notes().end());
  return this->SayReasons(work.Reasons);
}

int vtkIsotetContour::SayReasons(const std::set<std::string>& reasons)
{
  for (const std::string& reason : reasons)
  {
    if (!this->Internal->Warned.count(reason))
    {
      vtkWarningMacro(<< reason);
    }
  }
  this->Internal->Warned = reasons;
  this->UpdateProgress(1.0);
  return 1;
}

//------------------------------------------------------------------------------
void vtkIsotetContour::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  this->ContourValues->PrintSelf(os, indent);
  os << indent << "ComputeNormals: " << this->ComputeNormals << "\n";
  os << indent << "ComputeScalars: " << this->ComputeScalars << "\n";
  os << indent << "OutputPointsPrecision: " << this->OutputPointsPrecision << "\n";
  os << indent << "ArrayComponent: " << this->ArrayComponent << "\n";
  os << indent << "GenerateTriangles: " << this->GenerateTriangles << "\n";
  os << indent << "ComputeGradients: " << this->ComputeGradients << "\n";
  os << indent << "UseScalarTree: " << this->UseScalarTree << "\n";
  os << indent << "FastMode: " << this->FastMode << "\n";
  os << indent << "ScalarTree: " << this->ScalarTree.GetPointer() << "\n";
  os << indent << "Locator: " << this->Locator.GetPointer() << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "Solid: " << this->Solid << "\n";
  os << indent << "ExpectedSurfaces: " << this->ExpectedSurfaces << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
  os << indent << "Controller: " << this->Controller << "\n";
}
