// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Tets on their way through packing.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace isotet::core {

/// A tet by the ranks of its corners: the places of its points along the curve.
using RankedTet = std::array<std::uint32_t, 4>;

inline std::uint32_t lowest_rank(const RankedTet& tet) {
    return std::min(std::min(tet[0], tet[1]), std::min(tet[2], tet[3]));
}

/// Where a tet comes from, in the user's order, and which way its split cell is turned.
struct TetOrigin {
    std::uint64_t value;

    static TetOrigin make(std::uint64_t cell, bool cell_negative) { return {cell << 1 | std::uint64_t{cell_negative}}; }
    std::uint64_t cell() const { return value >> 1; }
    bool cell_negative() const { return value & 1; }
};

} // namespace isotet::core
