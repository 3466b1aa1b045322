// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

class vtkAlgorithm;

namespace isotet::io::confined {

/// Takes over what VTK's classes print: errors are kept, and printed to stderr too (the parent keeps the last lines in
/// case of a crash).
void collect_vtk_messages();

/// The first error VTK has printed since the last call, without its source position; nothing if there was none.
std::optional<std::string> take_vtk_error();

/// Passes on the progress of a VTK reader.
void follow_progress(vtkAlgorithm* algorithm);

} // namespace isotet::io::confined
