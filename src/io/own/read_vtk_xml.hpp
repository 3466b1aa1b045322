// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTK's XML formats as readers of isotet::read().
#pragma once

#include <string>
#include <vector>

#include "io/own/loaded.hpp"
#include "io/reader.hpp"

namespace isotet::io {

/// VTU, PVTU, VTI, VTR, VTS and PVD.
std::vector<GridReader> vtk_xml_readers();

/// A PVD: an index of files of these formats by time; those of one time are pieces of one grid.
Result<Loaded> load_collection(const std::string& path, const ReadOptions& options, Depth depth,
                               const Progress& progress);

} // namespace isotet::io
