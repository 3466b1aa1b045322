// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is in a grid, line by line: of what isotet read, and of what VTK's own readers give of the same file.
#pragma once

#include <string>
#include <vector>

#include <isotet/read.hpp>

class vtkDataSet;

namespace isotet::test {

/// Types, names, order and the bits of all arrays.
std::vector<std::string> digest(const Grid& grid);
std::vector<std::string> digest(vtkDataSet* data);

/// What VTK's reader for this ending makes of a file; empty where it reports an error.
std::vector<std::string> read_with_vtk(const std::string& path);

/// The same in a child process, since broken files make VTK crash; empty then, too.
std::vector<std::string> read_with_vtk_apart(const std::string& path);

} // namespace isotet::test
