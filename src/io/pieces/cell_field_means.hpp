// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A cell field as a point field, of cells that stay in their files.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/pieces/loaded.hpp"
#include "io/pieces/join/point_numbers.hpp"

namespace isotet::io {

/// A piece, and the numbers of its points in the grid; null: they are the same.
struct NumberedPiece {
    const Piece* piece;
    const PieceNumbers* numbers;
    std::uint64_t points;
};

/// What find_field() gives for a cell field of the joined grid, a component of one, or an expression of some: values are read
/// and cells go by piece after piece, once. Nothing where all cells are needed: some have no volume or are broken, pieces
/// differ in their fields, or the name means something else.
///
/// `pieces`   with cells, in the order of the grid
/// `points`   of the grid
/// Errors     as CellSource and FieldSource; out_of_memory; cancelled
Result<std::optional<PointField>> means_of_cells(const std::vector<NumberedPiece>& pieces, const Array& points,
                                                 const std::string& name, const Progress& progress);

} // namespace isotet::io
