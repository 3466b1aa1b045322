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
#include "core/orientation.hpp"

namespace isotet::core {

/// A tet by the cell it comes from and which piece of it (0 to 5).
struct TetId {
    std::uint64_t value;
    static TetId make(std::uint64_t cell, unsigned piece) { return {cell << 3 | piece}; }
    std::uint64_t cell() const { return value >> 3; }
    unsigned piece() const { return static_cast<unsigned>(value & 7); }
};

/// What one pass over all cells finds out.
struct TetSurvey {
    std::array<double, 3> lower{}, upper{}; ///< bounds of the used points
    std::uint64_t tets = 0, collapsed = 0, left_out = 0;
    bool mostly_negative = false;
};

/// Bounds, counts and orientation of a checked grid. Parallel, one pass over the cells.
TetSurvey survey_tets(const Grid& grid, const CellReader& cells);

/// What one pass over the point numbers of all cells finds out.
struct TetCounts {
    std::uint64_t tets = 0, collapsed = 0, left_out = 0;
    Buffer<std::uint8_t> used; ///< by point: 1 when a tet has it
};

/// Counts the tets of a checked grid. Parallel. One byte a point.
TetCounts count_tets(const CellReader& cells);

/// A tet by the ranks of its corners: the places of its points along the curve.
using RankedTet = std::array<std::uint32_t, 4>;

/// Where a tet comes from, in the user's order, and which way its split cell is turned. Ascends with cell and piece.
struct TetOrigin {
    std::uint64_t value;

    static TetOrigin make(std::uint64_t cell, unsigned piece, bool cell_negative) {
        return {cell << 4 | piece << 1 | std::uint64_t{cell_negative}};
    }
    std::uint64_t cell() const { return value >> 4; }
    bool cell_negative() const { return value & 1; }
};

/// Every tet once, in its stored form, by its lowest rank, then by cell. Of tets with the same four corners the first in the
/// user's order stays; the others are dropped and counted. Deterministic for any thread count.
struct TetOrder {
    Buffer<RankedTet> tets;
    Buffer<TetOrigin> origins;      ///< of each tet, when wanted
    Buffer<std::uint64_t> point_of; ///< rank -> user's point
    Orienter::Counts orientation;   ///< of the tets that stay
    std::uint64_t inverted = 0, repeated = 0;
};

/// Sorts the points along a Hilbert curve, and the tets by their lowest point. Points are gathered from the user's arrays
/// along the curve, so that their order there matters little.
///
/// Cost     24 bytes a tet and 20 a point
/// Errors   invalid_data when tets use 2^32 points or more; cancelled
Result<TetOrder> sort_tets(const Grid& grid, const CellReader& cells, TetCounts counts, bool keep_origins, const Progress& progress);

} // namespace isotet::core
