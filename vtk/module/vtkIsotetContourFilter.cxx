// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vtkIsotetContourFilter.h"

#include <cstdlib>
#include <list>
#include <mutex>
#include <string>

#include "vtkDataArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVersion.h"

#include "block.hpp"
#include "fallback.hpp"
#include "run.hpp"

vtkStandardNewMacro(vtkIsotetContourFilter);

namespace
{

/// Blocks that were contoured, the last one first. A grid is known by its cell array, that of one filter from that of
/// another is not told: they share what is packed.
struct Kept
{
  std::mutex Mutex; ///< held while a block is used
  std::list<std::pair<const void*, isotet_vtk::Block>> Blocks;
  vtkTypeInt64 MemoryLimit = vtkTypeInt64{ 4 } << 30;

  isotet_vtk::Block& Find(const void* key);
  void Shrink();
};

Kept& KeptBlocks()
{
  static Kept& kept = *new Kept; // filters may execute while statics are destroyed
  return kept;
}

isotet_vtk::Block& Kept::Find(const void* key)
{
  auto found = this->Blocks.begin();
  while (found != this->Blocks.end() && found->first != key)
  {
    ++found;
  }
  if (found == this->Blocks.end())
  {
    this->Blocks.emplace_front(key, isotet_vtk::Block());
  }
  else
  {
    this->Blocks.splice(this->Blocks.begin(), this->Blocks, found);
  }
  return this->Blocks.front().second;
}

/// The ones not used for longest go, and those beyond 64, which may be of grids that are gone.
void Kept::Shrink()
{
  vtkTypeInt64 bytes = 0;
  std::size_t count = 0;
  for (auto it = this->Blocks.begin(); it != this->Blocks.end();)
  {
    bytes += static_cast<vtkTypeInt64>(it->second.packed_bytes());
    ++count;
    it = count > 1 && (bytes > this->MemoryLimit || count > 64) ? this->Blocks.erase(it) : std::next(it);
  }
}

thread_local int Suspended = 0;

vtkObject* Create()
{
  if (Suspended > 0)
  {
    return nullptr;
  }
  return vtkIsotetContourFilter::New();
}

class Factory : public vtkObjectFactory
{
public:
  static Factory* New()
  {
    auto* const factory = new Factory;
    factory->InitializeObjectBase();
    return factory;
  }
  vtkTypeMacro(Factory, vtkObjectFactory);
  const char* GetVTKSourceVersion() override { return VTK_SOURCE_VERSION; }
  const char* GetDescription() override { return "isotet for vtkContourFilter"; }

  /// Without an object VTK makes its own.
  vtkObject* CreateObject(const char* name) override
  {
    return std::string(name) == "vtkContourFilter" ? Create() : nullptr;
  }

protected:
  Factory()
  {
    this->RegisterOverride("vtkContourFilter", "vtkIsotetContourFilter", "isotet", 1, &Create);
  }
};

vtkSmartPointer<Factory>& Registered()
{
  static vtkSmartPointer<Factory> factory;
  return factory;
}

bool IsAskedForByEnvironment()
{
  const char* const asked = std::getenv("ISOTET_REPLACE_CONTOUR");
  return asked && std::string(asked) == "1";
}

const struct AtLoad
{
  AtLoad()
  {
    if (IsAskedForByEnvironment())
    {
      vtkIsotetContourFilter::SetEnabled(true);
    }
  }
} atLoad;

} // namespace

//------------------------------------------------------------------------------
vtkIsotetContourFilter::Suspend::Suspend()
{
  ++Suspended;
}

vtkIsotetContourFilter::Suspend::~Suspend()
{
  --Suspended;
}

void vtkIsotetContourFilter::SetEnabled(bool enabled)
{
  vtkSmartPointer<Factory>& factory = Registered();
  if (enabled && !factory)
  {
    factory.TakeReference(Factory::New());
    vtkObjectFactory::RegisterFactory(factory);
  }
  else if (!enabled && factory)
  {
    vtkObjectFactory::UnRegisterFactory(factory);
    factory = nullptr;
  }
}

bool vtkIsotetContourFilter::GetEnabled()
{
  return Registered() != nullptr;
}

void vtkIsotetContourFilter::SetMemoryLimit(vtkTypeInt64 bytes)
{
  Kept& kept = KeptBlocks();
  const std::lock_guard<std::mutex> lock(kept.Mutex);
  kept.MemoryLimit = bytes;
  kept.Shrink();
}

vtkTypeInt64 vtkIsotetContourFilter::GetMemoryLimit()
{
  return KeptBlocks().MemoryLimit;
}

void vtkIsotetContourFilter::Clear()
{
  Kept& kept = KeptBlocks();
  const std::lock_guard<std::mutex> lock(kept.Mutex);
  kept.Blocks.clear();
}

//------------------------------------------------------------------------------
int vtkIsotetContourFilter::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->UsedIsotet = this->ContourByIsotet(inputs, outputs);
  if (this->UsedIsotet)
  {
    return 1;
  }
  const Suspend suspend;
  return this->Superclass::RequestData(request, inputs, outputs);
}

/// False: nothing was done.
bool vtkIsotetContourFilter::ContourByIsotet(
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  auto* const grid = vtkUnstructuredGrid::GetData(inputs[0]);
  vtkPolyData* const out = vtkPolyData::GetData(outputs);
  if (!grid || !out || grid->GetNumberOfCells() == 0 || this->ComputeGradients || !this->GenerateTriangles)
  {
    return false;
  }
  int association = vtkDataObject::FIELD_ASSOCIATION_POINTS;
  vtkDataArray* const scalars = this->GetInputArrayToProcess(0, grid, association);
  if (!scalars || association != vtkDataObject::FIELD_ASSOCIATION_POINTS ||
    !isotet_vtk::reason_against(grid, scalars).empty())
  {
    return false;
  }
  isotet_vtk::Wishes wishes;
  wishes.isovalues.assign(this->GetValues(), this->GetValues() + this->GetNumberOfContours());
  wishes.normals = this->ComputeNormals;
  wishes.scalars = this->ComputeScalars;
  const bool is_float = grid->GetPoints()->GetDataType() == VTK_FLOAT && scalars->GetDataType() == VTK_FLOAT;
  if (!is_float || this->OutputPointsPrecision == DOUBLE_PRECISION)
  {
    wishes.points = isotet::Precision::float64; // needs no agreement with other pieces
  }

  isotet_vtk::AlgorithmRun run(this, 0);
  Kept& kept = KeptBlocks();
  const std::lock_guard<std::mutex> lock(kept.Mutex);
  isotet_vtk::Block& block = kept.Find(grid->GetCells());
  const auto taken = block.take(grid, scalars, wishes);
  bool done = taken && block.has_contoured() && !block.cells().has_others();
  std::string error = taken ? std::string() : taken.error().message;
  if (done)
  {
    const auto contoured = block.extract({}, false, run.run(), out);
    done = static_cast<bool>(contoured);
    error = contoured ? std::string() : contoured.error().message;
  }
  block.release();
  kept.Shrink();
  if (!error.empty() && !run.cancelled())
  {
    vtkWarningMacro(<< "vtkContourFilter's own code is used: " << error);
  }
  return done || run.cancelled();
}

void vtkIsotetContourFilter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "UsedIsotet: " << this->UsedIsotet << "\n";
}
