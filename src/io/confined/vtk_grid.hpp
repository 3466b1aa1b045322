// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From VTK's data sets to pieces. Arrays are shared with VTK, not copied, where their memory layout allows it.
#pragma once

#include <vector>

#include <isotet/read.hpp>

#include "io/pieces/loaded.hpp"

class vtkAlgorithm;
class vtkDataArray;
class vtkDataArraySelection;
class vtkDataObject;
class vtkDataSet;
class vtkInformation;

namespace isotet::io::confined {

/// The array, sharing its memory.
Array shared_array(vtkDataArray* values);

std::optional<ScalarType> scalar_type(int vtk_type);

/// A data set as a piece; structured ones as hexahedra. Only fields that the options want are taken; ghost marks and
/// global numbers are taken out of the fields.
Result<Piece> piece_of(vtkDataSet* data, const ReadOptions& options, std::string name, std::vector<std::string>& notes);

/// All data sets in a tree of blocks, one piece each, or the one data set.
Result<std::vector<Piece>> pieces_of(vtkDataObject* data, const ReadOptions& options, std::vector<std::string>& notes);

/// Adds the fields of a data set (or of all blocks of a tree) to the description.
void announce_fields(vtkDataObject* data, FileInfo& info);

/// Adds the data sets of a tree to the description as blocks, numbered from 1; a data set alone is none.
void announce_blocks(vtkDataObject* data, FileInfo& info, const char* kind);

/// Switches on the arrays that the options want and nothing else.
void choose_arrays(vtkDataArraySelection* selection, const ReadOptions& options, Association association);

/// The times that a reader announces in its output information.
std::vector<double> announced_times(vtkAlgorithm& reader);

/// Runs a reader, for one time step if there are several; its errors become an Error.
Result<void> update_information(vtkAlgorithm& reader, const std::string& path);
Result<void> update(vtkAlgorithm& reader, const std::string& path, const std::vector<double>& times, std::size_t step);

/// True for arrays that describe the grid (ghost marks), which are no fields.
bool is_ghost_array(std::string_view name);

} // namespace isotet::io::confined
