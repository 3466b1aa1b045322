// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A cell field as a point field, of cells that stay in their file.
#pragma once

#include <optional>
#include <string>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/pieces/loaded.hpp"

namespace isotet::io {

/// What find_field() gives for a cell field, or a component of one, of a piece that is the grid: its values are read, and the
/// cells go by once. Nothing where all cells are needed: some have no volume, are broken, or the field is none.
///
/// Errors   as CellSource and FieldSource; out_of_memory; cancelled
Result<std::optional<PointField>> means_of_cells(const Piece& piece, const std::string& name, const Progress& progress);

} // namespace isotet::io
