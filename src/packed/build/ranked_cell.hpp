// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Tets and other cells on their way through packing.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "grid/cell/cell_kind.hpp"

namespace isotet::core {

/// A tet by the ranks of its corners: the places of its points along the curve.
using RankedTet = std::array<std::uint32_t, 4>;

inline std::uint32_t lowest_rank(const RankedTet& tet) {
    return std::min(std::min(tet[0], tet[1]), std::min(tet[2], tet[3]));
}

/// A cell of any kind. Behind its last corner stands no_corner, which is above all ranks.
struct RankedCell {
    static constexpr std::uint32_t no_corner = std::numeric_limits<std::uint32_t>::max();

    std::array<std::uint32_t, 8> corners;

    CellKind kind() const {
        if (corners[6] != no_corner) return CellKind::hexahedron;
        if (corners[5] != no_corner) return CellKind::wedge;
        return corners[4] != no_corner ? CellKind::pyramid : CellKind::tetrahedron;
    }
};

inline std::uint32_t lowest_rank(const RankedCell& cell) {
    return *std::min_element(cell.corners.begin(), cell.corners.end());
}

/// Where a stored cell comes from, in the user's order, and which way the cell is turned of which it is a piece.
struct CellOrigin {
    std::uint64_t value;

    static CellOrigin make(std::uint64_t cell, bool cell_negative) {
        return {cell << 2 | std::uint64_t{cell_negative}};
    }
    static CellOrigin make_ordered(std::uint64_t cell) { return {cell << 2 | 2}; }
    std::uint64_t cell() const { return value >> 2; }
    bool cell_negative() const { return value & 1; }
    bool is_ordered() const { return value & 2; } ///< the cell's corners stay in their order
};

} // namespace isotet::core
