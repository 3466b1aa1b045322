// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/result.hpp>

class vtkDataSet;

namespace isotet::io::confined {

/// A structured, rectilinear or image grid as hexahedra, with a note that says so; nothing for other data sets. A flat
/// one has no hexahedra.
///
/// Errors   out_of_memory
Result<std::optional<Grid>> hexahedra_of(vtkDataSet* data, std::vector<std::string>& notes);

} // namespace isotet::io::confined
