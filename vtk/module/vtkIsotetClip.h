// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkIsotetClip
 * @brief the part of a grid on one side of an isosurface, or between two, as cells
 *
 * Cells on the side are kept as they are, those that the isosurface crosses are cut. What is on the side, and which array
 * decides, is told as to vtkIsotetContour: SetValue(), SetInputArrayToProcess(), SetSolidToAbove() (the default), Below,
 * Between. The output is a vtkUnstructuredGrid, or composite data with the blocks of the input; it has all point and cell
 * arrays. Other data sets are converted before; their 2D cells, lines, curved cells without a Tolerance, and ghost cells are
 * left out. Pieces on several ranks are clipped one by one, without ghost cells, and fit. Every rank must execute the filter.
 */
#ifndef vtkIsotetClip_h
#define vtkIsotetClip_h

#include "vtkIsotetContour.h"
#include "vtkIsotetModule.h" // For export macro

class VTKISOTET_EXPORT vtkIsotetClip : public vtkIsotetContour
{
public:
  static vtkIsotetClip* New();
  vtkTypeMacro(vtkIsotetClip, vtkIsotetContour);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Whether cut cells that are no tetrahedra, pyramids, wedges or hexahedra are polyhedra; off: they are split into such. On by
   * default.
   */
  vtkSetMacro(Polyhedra, vtkTypeBool);
  vtkGetMacro(Polyhedra, vtkTypeBool);
  vtkBooleanMacro(Polyhedra, vtkTypeBool);
  ///@}

protected:
  vtkIsotetClip();
  ~vtkIsotetClip() override = default;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  bool NeedsGhosts() const override { return false; }
#ifndef __VTK_WRAP__
  vtkSmartPointer<vtkDataSet> NewLeaf() override;
#endif

  vtkTypeBool Polyhedra = 1;

private:
  vtkIsotetClip(const vtkIsotetClip&) = delete;
  void operator=(const vtkIsotetClip&) = delete;
};

#endif
