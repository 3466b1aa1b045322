// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The fields of pieces as those of one grid.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/pieces/loaded.hpp"
#include "io/pieces/join/point_numbers.hpp"

namespace isotet::io {

/// Joins fields of points. Where points were joined, the value is that of the first piece that has data there; fields
/// whose values differ there by more than rounding are told. A field that only some pieces have is NaN
/// elsewhere (integers become float64), one with different numbers of components is left out: `whole` tells both.
/// Frees the fields of the pieces.
///
/// Errors   out_of_memory; cancelled
Result<std::vector<Field>> join_point_fields(std::vector<Piece>& pieces, const PointNumbers& numbers,
                                             std::span<const JoinedPoint> joined, ReadResult& whole,
                                             const Progress& progress);

/// The same of kept cells.
///
/// `first`   by piece: the number of its first cell in the joined grid;  `kept`   by piece: how many it gives
/// `count`   cells of that grid
Result<std::vector<Field>> join_cell_fields(std::vector<Piece>& pieces, std::span<const std::uint64_t> first,
                                            std::span<const std::uint64_t> kept, std::uint64_t count, ReadResult& whole,
                                            const Progress& progress);

/// The coordinates.
Result<Array> join_points(std::vector<Piece>& pieces, const PointNumbers& numbers);

} // namespace isotet::io
