// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells as they are stored where they are not split: native cells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "grid/cell/split.hpp"
#include "grid/cell/splitter.hpp"
#include "grid/orientation.hpp"

namespace isotet::core {

/// Whether some of the first n corners are equal.
template <class Corner>
bool has_repeated_corner(const std::array<Corner, 8>& corners, std::size_t n) {
    bool repeated = false;
    for (std::size_t a = 0; a < n; ++a)
        for (std::size_t b = a + 1; b < n; ++b) repeated |= corners[a] == corners[b];
    return repeated;
}

inline bool has_repeated_corner(const WholeCell& cell) {
    return has_repeated_corner(cell.corners, corner_count(cell.kind));
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

/// Of the tets of a cell, how many more are upright than negative; exact once no further one can change the sign.
/// `At`   places of corners; see turn_of()
template <class At>
class UprightLead {
public:
    explicit UprightLead(const At& at) : at_(at) {}

    void expect(int tets) { left_ = tets; }
    void add(std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d) {
        if (lead_ >= left_ || -lead_ > left_) return;
        lead_ += orientation_sign(at_(a), at_(b), at_(c), at_(d));
        --left_;
    }
    bool is_negative() const { return lead_ < 0; }

private:
    const At& at_;
    int lead_ = 0, left_ = 0;
};

/// Whether turn_of() has more negative tets than upright ones; looks at as few as tell.
/// `corners`   point numbers; tets with repeated ones are flat
template <class Corner, class At>
bool is_mirrored(CellKind kind, const std::array<Corner, 8>& corners, const At& at) {
    UprightLead lead(at);
    Splitter(corners.data(), lead).split(kind);
    return lead.is_negative();
}

} // namespace isotet::core
