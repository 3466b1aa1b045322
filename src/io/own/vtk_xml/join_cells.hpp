// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The cells of several Piece elements of a file as those of one grid.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/result.hpp>

namespace isotet::io::vtk_xml {

/// The numbers of a piece's cells must be its own points, before they become numbers of the whole grid.
/// Errors   invalid_data
Result<void> check_corners(const Cells& cells, std::uint64_t points);

/// The cells of all pieces in one list; those of each have been checked.
/// `points`   how many each piece has
Cells join_cells(const std::vector<Cells>& parts, const std::vector<std::uint64_t>& points);

} // namespace isotet::io::vtk_xml
