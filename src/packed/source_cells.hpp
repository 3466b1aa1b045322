// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The user's numbers of the cells that unpack() gives.
#pragma once

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "packed/packed.hpp"

namespace isotet::core {

/// One uint64 for each stored cell, in the order of unpack(). All of the grid is in memory, and was packed with source cells.
ISOTET_API Array source_cells_of(const Packed& packed);

} // namespace isotet::core
