// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vtkIsotetReader.h"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <isotet/packed_file.hpp>

#include "vtkDataArraySelection.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnstructuredGrid.h"

#include "arrays.hpp"
#include "run.hpp"
#include "unstructured.hpp"

vtkStandardNewMacro(vtkIsotetReader);

namespace
{

/// Tells a file that was written again.
struct Stamp
{
  std::string Name;
  std::filesystem::file_time_type Time{};
  std::uintmax_t Size = 0;
  bool operator==(const Stamp&) const = default;
};

Stamp StampOf(const std::string& name)
{
  std::error_code error;
  return { name, std::filesystem::last_write_time(name, error), std::filesystem::file_size(name, error) };
}

} // namespace

struct vtkIsotetReader::Internals
{
  vtkNew<vtkDataArraySelection> Arrays;
  std::optional<isotet::PackedFile> File;
  Stamp Opened;
  std::vector<double> Times;
  vtkSmartPointer<vtkUnstructuredGrid> Cells; ///< with points, without arrays: of all steps

  std::string Open(const std::string& name);
  void ListArrays();
  std::size_t StepAt(double time) const;
  std::string Read(std::size_t step, const isotet::Run& run, vtkUnstructuredGrid* out);
};

/// Empty, or why not.
std::string vtkIsotetReader::Internals::Open(const std::string& name)
{
  const Stamp stamp = StampOf(name);
  if (this->File && stamp == this->Opened)
  {
    return {};
  }
  this->File.reset();
  this->Cells = nullptr;
  auto file = isotet::PackedFile::open(name);
  if (!file)
  {
    return file.error().message;
  }
  this->File = *file;
  this->Opened = stamp;
  this->Times = file->info().times;
  if (this->Times.empty())
  {
    this->Times.resize(file->info().steps);
    std::iota(this->Times.begin(), this->Times.end(), 0.0);
  }
  this->ListArrays();
  return {};
}

/// Arrays that were known before keep their status.
void vtkIsotetReader::Internals::ListArrays()
{
  vtkNew<vtkDataArraySelection> before;
  before->CopySelections(this->Arrays);
  this->Arrays->RemoveAllArrays();
  for (const isotet::PackedFieldInfo& field : this->File->info().fields)
  {
    const char* const name = field.report.name.c_str();
    this->Arrays->AddArray(name, !before->ArrayExists(name) || before->ArrayIsEnabled(name));
  }
}

/// The last step that is not after `time`; the first one before all.
std::size_t vtkIsotetReader::Internals::StepAt(double time) const
{
  const auto after = std::upper_bound(this->Times.begin(), this->Times.end(), time);
  return after == this->Times.begin() ? 0 : static_cast<std::size_t>(after - this->Times.begin()) - 1;
}

std::string vtkIsotetReader::Internals::Read(std::size_t step, const isotet::Run& run, vtkUnstructuredGrid* out)
{
  if (!this->Cells)
  {
    const isotet::PackedFieldInfo& any = this->File->info().fields.front();
    const auto packed = this->File->grid(any.report.name, any.step, run);
    const auto grid = packed ? isotet::unpack(*packed, run) : isotet::Result<isotet::Grid>(packed.error());
    if (!grid)
    {
      return grid.error().message;
    }
    this->Cells = vtkSmartPointer<vtkUnstructuredGrid>::New();
    isotet_vtk::write_cells(*grid, this->Cells);
  }
  out->ShallowCopy(this->Cells);
  for (const isotet::PackedFieldInfo& info : this->File->info().fields)
  {
    const std::string& name = info.report.name;
    if (info.step != step || !this->Arrays->ArrayIsEnabled(name.c_str()))
    {
      continue;
    }
    const auto packed = this->File->grid(name, step, run);
    const auto field = packed ? isotet::unpack_field(*packed, run) : isotet::Result<isotet::Field>(packed.error());
    if (!field)
    {
      return field.error().message;
    }
    const auto array = isotet_vtk::to_vtk(field->values, name.c_str());
    out->GetPointData()->AddArray(array);
    if (!out->GetPointData()->GetScalars())
    {
      out->GetPointData()->SetActiveScalars(name.c_str());
    }
  }
  return {};
}

//------------------------------------------------------------------------------
vtkIsotetReader::vtkIsotetReader()
  : Internal(std::make_unique<Internals>())
{
  this->SetNumberOfInputPorts(0);
}

vtkIsotetReader::~vtkIsotetReader()
{
  this->SetFileName(nullptr);
}

vtkMTimeType vtkIsotetReader::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->Internal->Arrays->GetMTime());
}

int vtkIsotetReader::CanReadFile(const char* name)
{
  return name && isotet::PackedFile::is_one(name) ? 1 : 0;
}

vtkDataArraySelection* vtkIsotetReader::GetPointDataArraySelection()
{
  return this->Internal->Arrays;
}

//------------------------------------------------------------------------------
int vtkIsotetReader::RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* const info = outputs->GetInformationObject(0);
  info->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
  const std::string error = this->FileName ? this->Internal->Open(this->FileName) : "no FileName was given";
  if (!error.empty())
  {
    vtkErrorMacro(<< error);
    return 0;
  }
  const std::vector<double>& times = this->Internal->Times;
  if (times.size() < 2 && this->Internal->File->info().times.empty())
  {
    info->Remove(Pipeline::TIME_STEPS());
    info->Remove(Pipeline::TIME_RANGE());
    return 1;
  }
  const double range[] = { times.front(), times.back() };
  info->Set(Pipeline::TIME_STEPS(), times.data(), static_cast<int>(times.size()));
  info->Set(Pipeline::TIME_RANGE(), range, 2);
  return 1;
}

int vtkIsotetReader::RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* const info = outputs->GetInformationObject(0);
  vtkUnstructuredGrid* const out = vtkUnstructuredGrid::GetData(outputs);
  Internals& internal = *this->Internal;
  if (!internal.File)
  {
    return 0; // which was said
  }
  const std::size_t step =
    info->Has(Pipeline::UPDATE_TIME_STEP()) ? internal.StepAt(info->Get(Pipeline::UPDATE_TIME_STEP())) : 0;
  if (info->Get(Pipeline::UPDATE_PIECE_NUMBER()) > 0)
  {
    return 1;
  }
  isotet_vtk::AlgorithmRun run(this, this->NumberOfThreads);
  const std::string error = internal.Read(step, run.run(), out);
  if (!error.empty())
  {
    out->Initialize();
    if (run.cancelled())
    {
      return 1; // VTK knows
    }
    vtkErrorMacro(<< error);
    return 0;
  }
  if (info->Has(Pipeline::TIME_STEPS()))
  {
    out->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), internal.Times[step]);
  }
  return 1;
}

void vtkIsotetReader::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "FileName: " << (this->FileName ? this->FileName : "(none)") << "\n";
  os << indent << "NumberOfThreads: " << this->NumberOfThreads << "\n";
}
