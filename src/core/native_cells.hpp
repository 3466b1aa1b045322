// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells as they are stored where they are not split: native cells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/orientation.hpp"
#include "core/split.hpp"

namespace isotet::core {

inline bool has_repeated_corner(const WholeCell& cell) {
    bool repeated = false;
    const std::size_t n = corner_count(cell.kind);
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = a + 1; b < n; ++b) repeated |= cell.corners[a] == cell.corners[b];
    return repeated;
}

/// What is stored of one cell of the user's grid.
struct NativeParts {
    std::array<WholeCell, 6> cells;
    int count = 0;
    int collapsed = 0;     ///< tets with a repeated corner
    bool is_split = false; ///< it is none of the kinds: its quadrilateral faces may not fit those of its neighbours

    const WholeCell* begin() const { return cells.data(); }
    const WholeCell* end() const { return cells.data() + count; }
};

/// A cell with different corners is stored as it is. One with repeated corners is
///   the wedge, pyramid or tet to which it has collapsed, where some of its faces have vanished
///   itself, where none has, and no two of its faces share more than an edge
///   its tets otherwise
NativeParts native_parts(const WholeCell& cell);

/// The same cell inside out.
template <class Corner>
std::array<Corner, 8> mirrored(CellKind kind, const std::array<Corner, 8>& corners) {
    std::array<Corner, 8> out = corners;
    const auto& order = mirrored_corners[static_cast<std::size_t>(kind)];
    for (std::size_t k = 0; k < corner_count(kind); ++k) out[k] = corners[order[k]];
    return out;
}

/// How the tets of a cell are turned.
struct TurnOfCell {
    int upright = 0, negative = 0;

    bool is_mirrored() const { return negative > upright; } ///< stored inside out
    bool is_twisted() const { return upright && negative; } ///< whichever way it is stored, some tet is inverted
    bool is_flat() const { return upright + negative == 0; }
};

/// From the exact signs of the tets of a cell. `at(k)` is the place of corner k.
template <class At>
TurnOfCell turn_of(const WholeCell& cell, const At& at) {
    TurnOfCell turn;
    for (const auto& tet : split_locally(cell)) {
        const int sign = orientation_sign(at(tet[0]), at(tet[1]), at(tet[2]), at(tet[3]));
        turn.upright += sign > 0;
        turn.negative += sign < 0;
    }
    return turn;
}

/// Whether turn_of() has more negative tets than upright ones; looks at as few as tell.
template <class At>
bool is_mirrored(const WholeCell& cell, const At& at) {
    const LocalTets tets = split_locally(cell);
    int lead = 0, left = tets.count; // of upright tets
    for (const auto& tet : tets) {
        lead += orientation_sign(at(tet[0]), at(tet[1]), at(tet[2]), at(tet[3]));
        --left;
        if (lead >= left || -lead > left) break;
    }
    return lead < 0;
}

} // namespace isotet::core
