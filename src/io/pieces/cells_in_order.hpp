// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells that are left in a file, in their order.
#pragma once

#include <cstdint>
#include <functional>

#include <isotet/array.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/result.hpp>

#include "io/pieces/cell_source.hpp"

namespace isotet::io {

/// Cells [first, first + count) and their corners, uint64. The array is not kept, and nothing of the file is read.
using VisitInOrder = std::function<void(std::uint64_t first, std::uint64_t count, const Array& corners)>;

/// Calls visit() for some 10^5 whole cells after another, of the thread pool of the caller. Blocks of the file are decoded by
/// one thread.
///
/// Errors   as CellSource::each_block()
Result<void> each_in_order(const CellSource& cells, const VisitInOrder& visit);

/// The same, of a grid with these points.
CellsInTurn cells_in_turn(const CellSource& cells, const Array& points);

} // namespace isotet::io
