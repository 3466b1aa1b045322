// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Gocad's TSolid (.so), ascii: the tetrahedral grids of geologists.
#pragma once

#include <string_view>

#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::io {

/// Tells what a TSolid holds: its PROPERTIES on points, its TETRA_PROPERTIES on cells, and `tvolume`.
Result<FileInfo> inspect_gocad(std::string_view text, const Progress& progress);

/// Reads the first TSolid of a file.
///
/// Points (VRTX, PVRTX) and properties are float64; values equal to the property's NO_DATA_VALUE become NaN. An ATOM or
/// PATOM is the point that it refers to: the grid is welded there, and where a PATOM has other properties than its
/// point these are dropped, with a note. With ZPOSITIVE Depth the sign of z is changed, with a note. `tvolume`: int32
/// cell field, the number of the TVOLUME in the order of the file, from 0.
///
/// Errors   invalid_data: a rule of the format broken, with line, value and rule; a file without END is cut short
Result<ReadResult> parse_gocad(std::string_view text, const ReadOptions& options, const Progress& progress);

} // namespace isotet::io
