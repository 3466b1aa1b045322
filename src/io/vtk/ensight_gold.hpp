// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Is all there that the files of an EnSight Gold case promise? VTK's reader fills in zeros, or drops cells, where it is not.
#pragma once

#include <string>

#include <isotet/result.hpp>

namespace isotet::io::vtk {

/// Walks through the geometry and the variables of one step, ascii, C binary or Fortran binary: every count is compared with
/// what is left of the file, and every variable has as many values as the geometry has nodes or elements.
///
/// `step`   its number, from 0
///
/// Not looked at: cases of other types (EnSight 6), files with several steps in one (BEGIN TIME STEP), parts of a variable
/// that are partly undefined, and files that are not there, which VTK's reader tells.
///
/// Errors   invalid_data: the file, what it should have, and where it ends
/// Cost     binary files: a look at each part; ascii files: reading them once more
Result<void> check_ensight_gold(const std::string& case_file, std::size_t step);

} // namespace isotet::io::vtk
