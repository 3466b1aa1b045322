// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "io/own/loaded.hpp"

namespace isotet::io::vtk {

struct LegacyLayout {
    std::string dataset; ///< "UNSTRUCTURED_GRID" and so on
    FileInfo info;       ///< point and cell fields
};

/// Walks through a legacy VTK file without keeping its values: what it holds, and whether everything is as long as it
/// says. VTK's own reader fills in what is missing, or crashes. The walk ends quietly at the first word it does not
/// know.
///
/// Errors   invalid_data when the file ends inside something
/// Cost     O(number of sections) for binary files, one pass for ascii files
Result<LegacyLayout> legacy_layout(const std::string& path);

} // namespace isotet::io::vtk
