// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The cells of pieces as those of one grid.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/pieces/loaded.hpp"
#include "io/pieces/join/point_numbers.hpp"

namespace isotet::io {

struct JoinedCells {
    Cells cells;
    std::uint64_t count = 0;
    std::vector<std::uint64_t> first; ///< by piece: the number of its first cell in the joined grid
    std::vector<std::uint64_t> kept;  ///< by piece: how many cells it gives
};

/// The kept cells of checked pieces, one after another, with the numbers of the joined grid. Frees those of each piece
/// once they are copied.
///
/// `order`   of the pieces
/// Errors    out_of_memory; cancelled
Result<JoinedCells> join_cells(std::vector<Piece>& pieces, std::span<const std::size_t> order,
                               const PointNumbers& numbers, const Progress& progress);

/// Calls visit(begin, end, kept cells before) for blocks of a piece's cells, in parallel.
void each_kept_block(const std::vector<std::uint8_t>& left_out, std::uint64_t count,
                     const std::function<void(std::uint64_t, std::uint64_t, std::uint64_t)>& visit);

} // namespace isotet::io
