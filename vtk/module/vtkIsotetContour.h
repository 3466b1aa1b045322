// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkIsotetContour
 * @brief isosurfaces of unstructured grids that follow a moving isovalue
 *
 * Has the interface of vtkContourFilter, and its output: triangles with the isovalue under the name of the contoured array,
 * all other point arrays interpolated, cell arrays copied, and "Normals".
 *
 * The cells of a vtkUnstructuredGrid are packed when a second surface is asked for, and not again while modified times say
 * that they are the same: another isovalue costs the time of its surface, another array or time step that of storing
 * values, moved points that of storing points. Arrays of VTK are read where they are, with 32- or 64-bit cells.
 *
 * Composite data are taken whole: the output has the same blocks. The blocks of all ranks of the Controller are contoured as
 * one grid: surfaces have the same bits where pieces meet, without ghost cells. Ghost cells, where there are some, give no
 * triangles. Every rank must execute the filter, those without data, too. An error on one rank is one on all.
 *
 * What isotet does not contour is given to vtkContourFilter, with a warning that says why: data sets of other classes,
 * cells that are neither linear 3D cells nor polyhedra, nor, with a Tolerance, curved ones, and all where GenerateTriangles is
 * off.
 *
 * Differs from vtkContourFilter: vertices are welded exactly; triangles are counter-clockwise, and normals point, towards
 * higher values; normals are gradients of the array; points without data (NaN) give no triangles; integer point
 * arrays are rounded to the nearest integers. A component of an array is contoured in any data set.
 */
#ifndef vtkIsotetContour_h
#define vtkIsotetContour_h

#include "vtkIsotetModule.h" // For export macro
#include "vtkIncrementalPointLocator.h" // For a smart pointer
#include "vtkPolyDataAlgorithm.h"
#include "vtkScalarTree.h"   // For a smart pointer
#include "vtkSmartPointer.h" // For members

#include <memory> // For std::unique_ptr
#include <set>    // For warnings
#include <string> // For arguments

class vtkContourValues;
class vtkDataArray;
class vtkDataSet;
class vtkMultiProcessController;

#ifndef __VTK_WRAP__
namespace isotet_vtk
{
struct Leaf;
struct Wishes;
}
#endif

class VTKISOTET_EXPORT vtkIsotetContour : public vtkPolyDataAlgorithm
{
public:
  static vtkIsotetContour* New();
  vtkTypeMacro(vtkIsotetContour, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The isovalues, as in vtkContourFilter.
   */
  void SetValue(int i, double value);
  double GetValue(int i);
  double* GetValues();
  void GetValues(double* contourValues);
  void SetNumberOfContours(int number);
  vtkIdType GetNumberOfContours();
  void GenerateValues(int numContours, double range[2]);
  void GenerateValues(int numContours, double rangeStart, double rangeEnd);
  vtkMTimeType GetMTime() override;
  ///@}

  ///@{
  /**
   * Normals along the gradient of the array, towards higher values. On by default, as in vtkContourFilter. With pieces, one
   * level of ghost cells is asked for: with it, normals are those of the whole.
   */
  vtkSetMacro(ComputeNormals, vtkTypeBool);
  vtkGetMacro(ComputeNormals, vtkTypeBool);
  vtkBooleanMacro(ComputeNormals, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Whether points have the contoured array, which is their isovalue. On by default.
   */
  vtkSetMacro(ComputeScalars, vtkTypeBool);
  vtkGetMacro(ComputeScalars, vtkTypeBool);
  vtkBooleanMacro(ComputeScalars, vtkTypeBool);
  ///@}

  ///@{
  /**
   * SINGLE_PRECISION, DOUBLE_PRECISION (computed in double precision, too) or DEFAULT_PRECISION, that of the input.
   */
  vtkSetClampMacro(OutputPointsPrecision, int, SINGLE_PRECISION, DEFAULT_PRECISION);
  vtkGetMacro(OutputPointsPrecision, int);
  ///@}

  ///@{
  /**
   * Which component of an array with several is contoured. 0 by default; others have an array of isovalues of their own.
   */
  vtkSetClampMacro(ArrayComponent, int, 0, VTK_INT_MAX);
  vtkGetMacro(ArrayComponent, int);
  ///@}

  ///@{
  /**
   * Triangles; off: vtkContourFilter contours, and makes polygons. On by default.
   */
  vtkSetMacro(GenerateTriangles, vtkTypeBool);
  vtkGetMacro(GenerateTriangles, vtkTypeBool);
  vtkBooleanMacro(GenerateTriangles, vtkTypeBool);
  ///@}

  ///@{
  /**
   * Kept for the sake of code that sets them, without effect.
   */
  vtkSetMacro(ComputeGradients, vtkTypeBool);
  vtkGetMacro(ComputeGradients, vtkTypeBool);
  vtkBooleanMacro(ComputeGradients, vtkTypeBool);
  vtkSetMacro(UseScalarTree, vtkTypeBool);
  vtkGetMacro(UseScalarTree, vtkTypeBool);
  vtkBooleanMacro(UseScalarTree, vtkTypeBool);
  vtkSetMacro(FastMode, bool);
  vtkGetMacro(FastMode, bool);
  vtkBooleanMacro(FastMode, bool);
  vtkSetSmartPointerMacro(ScalarTree, vtkScalarTree);
  vtkGetSmartPointerMacro(ScalarTree, vtkScalarTree);
  vtkSetSmartPointerMacro(Locator, vtkIncrementalPointLocator);
  vtkGetSmartPointerMacro(Locator, vtkIncrementalPointLocator);
  void CreateDefaultLocator() {}
  ///@}

  /**
   * The point array of that name.
   */
  void SetInputArray(const std::string& name);

  ///@{
  /**
   * Above 0: quadratic cells and those of higher degree are refined until the array is within this of their own field, as a
   * share of its range: 0.001 is 0.1 %. 0, the default: vtkContourFilter contours them, in fixed linear pieces. Cells are
   * refined for each isovalue, in data sets that are no composite ones, on one rank; elsewhere, and Bezier pyramids,
   * vtkContourFilter contours them, with a warning.
   */
  vtkSetClampMacro(Tolerance, double, 0.0, 1.0);
  vtkGetMacro(Tolerance, double);
  ///@}

  enum Solids
  {
    NO_SOLID,     ///< isosurfaces
    SOLID_ABOVE,  ///< where the array is at least the value, of each
    SOLID_BELOW,  ///< where it is less
    SOLID_BETWEEN ///< from the smallest to the largest of at least two values
  };

  ///@{
  /**
   * Closed solids in place of isosurfaces: the isosurface and the part of the grid's boundary on one side of it, cut at it,
   * outward oriented. The cell array "boundary" is 1 on the boundary; points have the contoured array as it is there, and no
   * normals. Each block is a solid of its own. A grid in pieces on several ranks needs one level of ghost cells, which is asked
   * for. Data that VTK would contour are an error. The boundary is found anew in each execution. NO_SOLID by default.
   */
  vtkSetClampMacro(Solid, int, NO_SOLID, SOLID_BETWEEN);
  vtkGetMacro(Solid, int);
  void SetSolidToAbove() { this->SetSolid(SOLID_ABOVE); }
  void SetSolidToBelow() { this->SetSolid(SOLID_BELOW); }
  void SetSolidToBetween() { this->SetSolid(SOLID_BETWEEN); }
  ///@}

  ///@{
  /**
   * How many surfaces will be asked for, over all isovalues and time steps: from a few on, the first one packs. 0, the
   * default: not known.
   */
  vtkSetClampMacro(ExpectedSurfaces, int, 0, VTK_INT_MAX);
  vtkGetMacro(ExpectedSurfaces, int);
  ///@}

  ///@{
  /**
   * At most so many threads; 0, the default: VTK_SMP_MAX_THREADS of the environment, else as many as the process may use.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * Whose ranks have the pieces. Default: the global controller.
   */
  virtual void SetController(vtkMultiProcessController*);
  vtkGetObjectMacro(Controller, vtkMultiProcessController);
  ///@}

  enum Updates
  {
    NOTHING, ///< cells, points and values were kept
    FIELD,   ///< values were stored
    POINTS,  ///< points and values were stored
    GRID     ///< another grid
  };

  /**
   * What the last execution had to do before it extracted; of several blocks, the most.
   */
  int GetLastUpdate();

  /**
   * Whether the last execution extracted from packed grids, and the bytes that these take.
   */
  bool GetUsedPackedGrids();
  vtkTypeInt64 GetPackedBytes();

  /**
   * With a Tolerance: how far the array is at most from the field of curved cells in what the last execution made, in its
   * unit. 0 where nothing was refined.
   */
  double GetFieldBound();

  /**
   * The seconds that isotet extracted in the last execution: without packing, and what was done for VTK.
   */
  double GetExtractSeconds();

protected:
  vtkIsotetContour();
  ~vtkIsotetContour() override;

  vtkTypeBool ProcessRequest(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  virtual int RequestDataObject(vtkInformation*, vtkInformationVector**, vtkInformationVector*);
  int RequestUpdateExtent(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int SayReasons(const std::set<std::string>& reasons);

#ifndef __VTK_WRAP__
  /// What an execution is to make.
  virtual isotet_vtk::Wishes MakeWishes();

  /// The array that decides in a data set. Without one null, and the sentence: an error, or, where other blocks may have the
  /// array, what is missing.
  virtual vtkDataArray* FindArray(
    const isotet_vtk::Leaf& leaf, bool isAlone, std::string& error, std::string& missing);

  /// What the output has for each data set of the input, empty.
  virtual vtkSmartPointer<vtkDataSet> NewLeaf();
#endif

  /// Whether pieces need a level of ghost cells.
  virtual bool NeedsGhosts() const;

  vtkContourValues* ContourValues;
  vtkTypeBool ComputeNormals = 1;
  vtkTypeBool ComputeScalars = 1;
  int OutputPointsPrecision = DEFAULT_PRECISION;
  int ArrayComponent = 0;
  vtkTypeBool GenerateTriangles = 1;
  vtkTypeBool ComputeGradients = 0;
  vtkTypeBool UseScalarTree = 0;
  bool FastMode = false;
  vtkSmartPointer<vtkScalarTree> ScalarTree;
  vtkSmartPointer<vtkIncrementalPointLocator> Locator;
  double Tolerance = 0;
  int Solid = NO_SOLID;
  int ExpectedSurfaces = 0;
  int NumberOfThreads = 0;
  vtkMultiProcessController* Controller = nullptr;

private:
  struct Internals;
  std::unique_ptr<Internals> Internal;

  vtkIsotetContour(const vtkIsotetContour&) = delete;
  void operator=(const vtkIsotetContour&) = delete;
};

#endif
