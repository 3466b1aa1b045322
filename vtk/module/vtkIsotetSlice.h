// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkIsotetSlice
 * @brief cuts through unstructured grids along planes, spheres and other implicit functions
 *
 * The cut along the CutFunction is an isosurface of a field that is made of the points, so that all that vtkIsotetContour
 * does for isosurfaces holds: a plane that moves along its normal costs the time of its cut, composite data and pieces on
 * several ranks fit, and what isotet does not contour goes to VTK. SetValue() and so on are distances from the function, along
 * the normal of a plane, from the surface of a sphere or cylinder outwards; of other functions they are its values. Triangles
 * face that way. The cut carries all point and cell arrays, and has no normals. With a Tolerance curved cells are refined for
 * the carried arrays. Solid and the array to process have no effect.
 */
#ifndef vtkIsotetSlice_h
#define vtkIsotetSlice_h

#include "vtkIsotetContour.h"
#include "vtkIsotetModule.h" // For export macro

class vtkImplicitFunction;

class VTKISOTET_EXPORT vtkIsotetSlice : public vtkIsotetContour
{
public:
  static vtkIsotetSlice* New();
  vtkTypeMacro(vtkIsotetSlice, vtkIsotetContour);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * Along what is cut. Without one, the default, nothing is.
   */
  virtual void SetCutFunction(vtkImplicitFunction*);
  vtkGetObjectMacro(CutFunction, vtkImplicitFunction);
  ///@}

  vtkMTimeType GetMTime() override;

protected:
  vtkIsotetSlice();
  ~vtkIsotetSlice() override;

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  bool NeedsGhosts() const override { return false; }
#ifndef __VTK_WRAP__
  isotet_vtk::Wishes MakeWishes() override;
  vtkDataArray* FindArray(
    const isotet_vtk::Leaf& leaf, bool isAlone, std::string& error, std::string& missing) override;
#endif

  vtkImplicitFunction* CutFunction = nullptr;

private:
  struct Cuts;
  std::unique_ptr<Cuts> Kept;

  vtkIsotetSlice(const vtkIsotetSlice&) = delete;
  void operator=(const vtkIsotetSlice&) = delete;
};

#endif
