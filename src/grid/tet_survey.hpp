// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What one pass over all cells of a grid finds out about its tets.
#pragma once

#include <array>
#include <cstdint>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>

#include "base/buffer.hpp"
#include "grid/cells.hpp"
#include "grid/orientation.hpp"

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
    std::array<std::uint64_t, 256> cells_by_type{};
    Orienter::Counts orientation; ///< repeated tets too
    std::uint64_t mirrored = 0;   ///< tets whose stored form is mirrored, flat ones aside
    Buffer<std::uint8_t> used;    ///< by point: 1 when a tet has it
    std::uint64_t unused = 0;     ///< points that no tet has

    bool mostly_negative() const { return orientation.negative > orientation.upright; }
    /// Whether either no tet is mirrored when it is stored, or every one.
    bool all_alike() const { return orientation.flat == 0 && (mirrored == 0 || mirrored == tets); }
};

/// Bounds, counts and orientation of a checked grid. Parallel, one pass over the cells and one over the points; a byte
/// a point. Incomplete when cancelled.
TetSurvey survey_tets(const Grid& grid, const CellReader& cells, const Progress& progress = {});

/// What one pass over the point numbers of all cells finds out of what will be stored.
struct CellCounts {
    std::uint64_t stored = 0; ///< tets, or native cells; repeated ones too
    std::uint64_t collapsed = 0, left_out = 0;
    std::uint64_t split = 0;   ///< native cells of which only tets can be stored
    Buffer<std::uint8_t> used; ///< by point: 1 when something that is stored has it
};

/// Counts the tets of a checked grid. Parallel. One byte a point.
CellCounts count_tets(const CellReader& cells);

/// Counts the native cells (native_cells.hpp).
CellCounts count_native_cells(const CellReader& cells);

} // namespace isotet::core
