// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Lists of cells and their types in legacy VTK files.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "io/vtk_legacy/legacy_values.hpp"
#include "io/vtk_legacy/legacy_vtk.hpp"

namespace isotet::io {

/// What is wanted of a list of cells.
enum class LegacyList : std::uint8_t {
    skipped,         ///< nothing
    whole,           ///< all of it
    without_corners, ///< the same, but corners may stay in the file
};

/// Behind the word `keyword`, CELLS or POLYGONS and so on.
///
/// Errors   invalid_data: counts or offsets that do not fit; the list was there before
Result<void> read_legacy_cells(LegacyValues& values, std::string_view keyword, LegacyList wanted, LegacyCells& cells);

/// Corners that were left in the file, piece by piece and in parallel: take(first, corners), corners in the type of the
/// file, `first` of them before. False where take() says so, or a cell has another count of corners.
Result<bool> each_of_corners(LegacyValues& values, const CornersInFile& stored,
                             const std::function<bool(std::uint64_t first, const Array& corners)>& take);

/// Reads the corners that were left in the file.
Result<void> read_corners(LegacyValues& values, LegacyCells& cells);

/// Behind the word CELL_TYPES.
/// Errors   invalid_data: a type that is not between 0 and 255
Result<void> read_legacy_cell_types(LegacyValues& values, bool geometry, LegacyFile& file);

} // namespace isotet::io
