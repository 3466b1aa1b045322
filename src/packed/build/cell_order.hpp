// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// All cells of a grid that will be stored, along a Hilbert curve, repeated ones dropped: the first step of packing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>

#include "base/buffer.hpp"
#include "grid/cells.hpp"
#include "grid/orientation.hpp"
#include "grid/tet_survey.hpp"
#include "packed/build/ranked_buckets.hpp"

namespace isotet::core {

/// Every item once, in its stored form, by its lowest rank, then by the user's cell. Of those with the same corners the
/// first in the user's order stays; the others are dropped and counted. Deterministic for any thread count.
template <class Item>
struct CellOrder {
    RankedBuckets<Item> cells;      ///< sorted and numbered; with origins, when wanted
    Buffer<std::uint64_t> point_of; ///< rank -> user's point
    Orienter::Counts orientation;   ///< of what stays
    std::uint64_t inverted = 0, repeated = 0;
    std::array<std::uint64_t, cell_kind_count> kinds{};
};

struct CellOrderOptions {
    bool keep_origins = false;
    std::optional<bool> mostly_negative = {}; ///< of tetrahedra: how flat ones are turned; nothing: by majority
};

/// Sorts the points along a Hilbert curve, and what will be stored by its lowest point. Points are gathered from the
/// user's arrays along the curve, so that their order there matters little.
///
/// `Item`   RankedTet: all cells as tets; RankedCell: native cells
/// Cost     16 bytes a tet, 8 more with origins or where not all cells are tetrahedra (40 a native cell), and 36 a point
///          (44 of float64)
/// Errors   invalid_data when cells use 2^32 points or more; cancelled
template <class Item>
Result<CellOrder<Item>> sort_cells(const Grid& grid, const CellReader& cells, CellCounts counts,
                                   const CellOrderOptions& options, const Progress& progress);

} // namespace isotet::core
