// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// All tets of a grid along a Hilbert curve, repeated ones dropped: the first step of packing.
#pragma once

#include <cstdint>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>

#include "core/buffer.hpp"
#include "core/cells.hpp"
#include "core/orientation.hpp"
#include "core/tet_buckets.hpp"
#include "core/tet_survey.hpp"

namespace isotet::core {

/// Every tet once, in its stored form, by its lowest rank, then by cell. Of tets with the same four corners the first
/// in the user's order stays; the others are dropped and counted. Deterministic for any thread count.
struct TetOrder {
    TetBuckets tets;                ///< sorted and numbered; with origins, when wanted
    Buffer<std::uint64_t> point_of; ///< rank -> user's point
    Orienter::Counts orientation;   ///< of the tets that stay
    std::uint64_t inverted = 0, repeated = 0;
};

/// Sorts the points along a Hilbert curve, and the tets by their lowest point. Points are gathered from the user's
/// arrays along the curve, so that their order there matters little.
///
/// Cost     16 bytes a tet, 8 more with origins or where not all cells are tetrahedra, and 36 a point (44 of float64)
/// Errors   invalid_data when tets use 2^32 points or more; cancelled
Result<TetOrder> sort_tets(const Grid& grid, const CellReader& cells, TetCounts counts, bool keep_origins,
                           const Progress& progress);

} // namespace isotet::core
