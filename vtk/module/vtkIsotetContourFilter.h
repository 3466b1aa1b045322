// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkIsotetContourFilter
 * @brief vtkContourFilter, carried out by isotet where isotet can.
 *
 * SetEnabled(true) makes vtkContourFilter::New() return this class, from VTK 9.2 on: pipelines, state files and scripts stay
 * as they are. It is off unless switched on, or the environment has ISOTET_REPLACE_CONTOUR=1 when the library is loaded.
 *
 * Whatever isotet does not contour goes to vtkContourFilter's own code, without a word: data sets that are no
 * vtkUnstructuredGrid, grids with cells other than linear 3D cells and polyhedra, scalars with components,
 * ComputeGradients, and GenerateTriangles off.
 *
 * Filters come and go (ParaView makes one for each execution), so packed grids are kept for all of them together, the last
 * used ones within SetMemoryLimit(). Nothing is sent between processes: surfaces of pieces have the same vertices where
 * these meet, in single precision for float points and scalars, else in double precision.
 */
#ifndef vtkIsotetContourFilter_h
#define vtkIsotetContourFilter_h

#include "vtkContourFilter.h"
#include "vtkIsotetModule.h" // For export macro

class VTKISOTET_EXPORT vtkIsotetContourFilter : public vtkContourFilter
{
public:
  static vtkIsotetContourFilter* New();
  vtkTypeMacro(vtkIsotetContourFilter, vtkContourFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether vtkContourFilter::New() makes this class. Not while another thread makes filters.
   */
  static void SetEnabled(bool enabled);
  static bool GetEnabled();
  ///@}

  ///@{
  /**
   * The most that the kept packed grids may take together, in bytes; the last one is always kept. Default 4 GiB.
   */
  static void SetMemoryLimit(vtkTypeInt64 bytes);
  static vtkTypeInt64 GetMemoryLimit();
  ///@}

  /**
   * Drops all kept grids.
   */
  static void Clear();

  /**
   * Whether the last execution was isotet's.
   */
  vtkGetMacro(UsedIsotet, bool);

#ifndef __VTK_WRAP__
  /// While one lives in this thread, vtkContourFilter::New() makes VTK's own.
  class Suspend
  {
  public:
    Suspend();
    ~Suspend();
    Suspend(const Suspend&) = delete;
    Suspend& operator=(const Suspend&) = delete;
  };
#endif

protected:
  vtkIsotetContourFilter() = default;
  ~vtkIsotetContourFilter() override = default;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  bool UsedIsotet = false;

private:
  bool ContourByIsotet(vtkInformationVector**, vtkInformationVector*);

  vtkIsotetContourFilter(const vtkIsotetContourFilter&) = delete;
  void operator=(const vtkIsotetContourFilter&) = delete;
};

#endif
