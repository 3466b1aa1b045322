// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells as tets. Which diagonal a quadrilateral face gets follows from the point numbers alone, so neighbours agree.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <isotet/export.hpp>

#include "grid/cell/cell_kind.hpp"

namespace isotet::core {

/// Four point numbers.
using Tet = std::array<std::uint64_t, 4>;

/// A cell by the numbers of its points, as many as its kind has.
struct WholeCell {
    CellKind kind;
    std::array<std::uint64_t, 8> corners;
};

/// The tets of one cell: at most six. Tets with a repeated corner are left out and counted.
template <class Corner>
struct TetsOfCell {
    std::array<std::array<Corner, 4>, 6> tets;
    int count = 0;
    int collapsed = 0;

    void add(Corner a, Corner b, Corner c, Corner d) {
        if (a == b || a == c || a == d || b == c || b == d || c == d) ++collapsed;
        else tets[static_cast<std::size_t>(count++)] = {a, b, c, d};
    }
    const std::array<Corner, 4>* begin() const { return tets.data(); }
    const std::array<Corner, 4>* end() const { return tets.data() + count; }
};

using CellTets = TetsOfCell<std::uint64_t>; ///< by point number
using LocalTets = TetsOfCell<std::uint8_t>; ///< by position among the corners of the cell

/// By the rule of splitter.hpp.
CellTets split_cell(const WholeCell& cell);

/// The same tets, their corners as positions in `corners`, of which some may be equal.
ISOTET_API LocalTets split_locally(const WholeCell& cell);

} // namespace isotet::core
