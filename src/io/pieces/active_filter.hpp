// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Readers that need not keep all cells.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <isotet/active_cells.hpp>
#include <isotet/read.hpp>

namespace isotet::io {

/// Whether points coincide, of which more can only be said with all cells. `cells`   how many there are
bool may_coincide(const Array& points, std::uint64_t cells);

/// The field of which cells are active.
/// `known`   ReadResult::field
Result<PointField> active_field(const Grid& grid, const ReadActiveCells& active,
                                const std::optional<PointField>& known);

/// The filter for ReadOptions::active_cells; nothing where all cells must be read: the field is one of cells, or not
/// there, or points coincide, of which more can only be said with all cells.
///
/// `grid`   points and fields, without cells
/// `known`   ReadResult::field
/// `type`   of all cells; nothing where they have types of their own
/// `cells`   how many there are
/// `numbers`   of the cells that are kept are wanted
/// `isovalues`   those of ReadActiveCells::shares; get all for which cells are kept
std::optional<ActiveCellFilter> active_filter(const Grid& grid, const std::optional<PointField>& known,
                                              std::optional<CellType> type, std::uint64_t cells,
                                              const ReadOptions& options, bool numbers, std::vector<double>& isovalues);

} // namespace isotet::io
