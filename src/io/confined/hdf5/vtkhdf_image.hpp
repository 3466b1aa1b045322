// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "io/pieces/loaded.hpp"
#include "io/reader.hpp"

namespace isotet::io::confined {

/// A VTKHDF file of type ImageData, as hexahedra. Data sets of fields have the axes z, y, x, before them the step where there
/// are several, behind them the components.
///
/// Errors   invalid_data: no box, no origin, spacing or direction of three, three and nine numbers
Result<Loaded> load_vtkhdf_image(const std::string& path, const ReadOptions& options, Depth depth);

} // namespace isotet::io::confined
