// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "io/pieces/loaded.hpp"
#include "io/reader.hpp"

namespace isotet::io::confined {

/// A VTKHDF file of type OverlappingAMR: a group for each level, with its spacing, its boxes, and the values of these
/// one after another.
///
/// Errors   invalid_data: no origin, spacing or boxes; what boxes_as_pieces() finds
Result<Loaded> load_vtkhdf_amr(const std::string& path, const ReadOptions& options, Depth depth);

} // namespace isotet::io::confined
