// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Lists of cells and their types in legacy VTK files.
#pragma once

#include <string_view>

#include "io/own/legacy_values.hpp"
#include "io/own/legacy_vtk.hpp"

namespace isotet::io {

/// Behind the word `keyword`, CELLS or POLYGONS and so on. Without `geometry` they are stepped over.
///
/// Errors   invalid_data: counts or offsets that do not fit; the list was there before
Result<void> read_legacy_cells(LegacyValues& values, std::string_view keyword, bool geometry, LegacyCells& cells);

/// Behind the word CELL_TYPES.
/// Errors   invalid_data: a type that is not between 0 and 255
Result<void> read_legacy_cell_types(LegacyValues& values, bool geometry, LegacyFile& file);

} // namespace isotet::io
