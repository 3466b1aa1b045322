// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// All tets of a grid along a Hilbert curve, repeated ones dropped: the first step of packing.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>

#include "core/buffer.hpp"
#include "core/cells.hpp"

namespace isotet::core {

/// A tet by the cell it comes from and which piece of it (0 to 5).
struct TetId {
    std::uint64_t value;
    static TetId make(std::uint64_t cell, unsigned piece) { return {cell << 3 | piece}; }
    std::uint64_t cell() const { return value >> 3; }
    unsigned piece() const { return static_cast<unsigned>(value & 7); }
};

struct SortedTet {
    std::uint64_t key; ///< position of the centroid along the curve
    TetId tet;
};

/// What one pass over all cells finds out.
struct TetSurvey {
    std::array<double, 3> lower{}, upper{}; ///< bounds of the used points
    std::uint64_t tets = 0, collapsed = 0, left_out = 0;
    bool mostly_negative = false;
};

/// Bounds, counts and orientation of a checked grid. Parallel, one pass over the cells.
TetSurvey survey_tets(const Grid& grid, const CellReader& cells);

/// Every tet once, sorted along the curve, then by cell: 16 bytes a tet. Of tets with the same four corners the first in
/// the user's order stays; the others are dropped and counted. Deterministic for any thread count.
struct TetOrder {
    Buffer<SortedTet> tets;
    std::uint64_t repeated = 0;
};
Result<TetOrder> sort_tets(const Grid& grid, const CellReader& cells, const TetSurvey& survey, const Progress& progress);

} // namespace isotet::core
