// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
/**
 * @class vtkIsotetReader
 * @brief reads packed grids (.isotet) as vtkUnstructuredGrid
 *
 * Points have the numbers of the grid that was packed, and the fields of the file as arrays; cells come in the order of the
 * file, which keeps no cell fields for them. Steps are VTK's time steps: 0, 1, 2, ... where the file has no times. Points and
 * cells are read once for all steps. In parallel the first piece has all.
 */
#ifndef vtkIsotetReader_h
#define vtkIsotetReader_h

#include "vtkIsotetModule.h" // For export macro
#include "vtkUnstructuredGridAlgorithm.h"

#include <memory> // For std::unique_ptr

class vtkDataArraySelection;

class VTKISOTET_EXPORT vtkIsotetReader : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkIsotetReader* New();
  vtkTypeMacro(vtkIsotetReader, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * The file.
   */
  vtkSetFilePathMacro(FileName);
  vtkGetFilePathMacro(FileName);
  ///@}

  /**
   * Whether the file begins as packed files do.
   */
  virtual int CanReadFile(VTK_FILEPATH const char* name);

  /**
   * Which fields are read; all by default. Known after UpdateInformation().
   */
  vtkDataArraySelection* GetPointDataArraySelection();

  ///@{
  /**
   * At most so many threads; 0, the default: VTK_SMP_MAX_THREADS of the environment, else as many as the process may use.
   */
  vtkSetClampMacro(NumberOfThreads, int, 0, VTK_INT_MAX);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  vtkMTimeType GetMTime() override;

protected:
  vtkIsotetReader();
  ~vtkIsotetReader() override;

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  char* FileName = nullptr;
  int NumberOfThreads = 0;

private:
  struct Internals;
  std::unique_ptr<Internals> Internal;

  vtkIsotetReader(const vtkIsotetReader&) = delete;
  void operator=(const vtkIsotetReader&) = delete;
};

#endif
