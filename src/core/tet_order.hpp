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

/// How many tets there are, by chunks of cells, and which points they use.
struct TetCounts {
    static constexpr std::size_t cells_a_chunk = 1 << 14;

    std::vector<std::uint64_t> first; ///< where each chunk's tets start, and how many there are in all
    Buffer<std::uint8_t> used;        ///< by point: 1 when a tet has it
    std::uint64_t collapsed = 0, left_out = 0;

    std::uint64_t tets() const { return first.back(); }
};

/// Counts the tets of a checked grid. Parallel, one pass over the point numbers of the cells. One byte a point.
TetCounts count_tets(const CellReader& cells);

/// A tet on its way through sorting.
struct SortedTet {
    std::uint64_t key; ///< position of the centroid along the curve
    std::uint64_t id;  ///< ascends with cell and piece

    static SortedTet make(std::uint64_t key, TetId tet, TetSigns signs) { return {key, tet.value << 3 | signs.bits()}; }
    TetId tet() const { return {id >> 3}; }
    TetSigns signs() const { return TetSigns::from_bits(id & 7); }
};

/// Every tet once, sorted along the curve, then by cell: 16 bytes a tet. Of tets with the same four corners the first in
/// the user's order stays; the others are dropped and counted. Deterministic for any thread count.
struct TetOrder {
    Buffer<SortedTet> tets;
    std::uint64_t repeated = 0;
    bool mostly_negative = false; ///< most of the whole tetrahedra are
};

/// Cost   32 bytes a tet, or 16 a tet and 33 a point
Result<TetOrder> sort_tets(const Grid& grid, const CellReader& cells, TetCounts counts, const Progress& progress);

} // namespace isotet::core
