// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/piece_table.hpp"

#include <cstddef>

namespace isotet::solid {

namespace {

using KindTable = std::array<std::vector<PieceCase>, 2>; ///< for the lower and the upper isovalue

PieceCase make_case(core::CellKind kind, unsigned inside, bool of_upper) {
    const auto is_inside = [inside](std::size_t corner) { return (inside >> corner & 1) != 0; };
    CellToCut cell;
    cell.kind = kind;
    for (std::size_t k = 0; k < core::corner_count(kind); ++k)
        cell.states[k] = is_inside(k) ? CornerState::inside : of_upper ? CornerState::above : CornerState::below;
    PieceCase out;
    out.exact = pieces_of(cell, IsosurfaceFaces::triangles);
    out.flat = pieces_of(cell, IsosurfaceFaces::flat);
    for (const auto& edge : core::edges_of(kind))
        if (is_inside(edge[0]) != is_inside(edge[1])) out.edges.push_back(edge);
    return out;
}

KindTable make_table(core::CellKind kind) {
    KindTable table;
    for (const bool of_upper : {false, true})
        for (unsigned inside = 0; inside < 1u << core::corner_count(kind); ++inside)
            table[of_upper].push_back(make_case(kind, inside, of_upper));
    return table;
}

template <core::CellKind kind>
const KindTable& table_of() {
    static const KindTable table = make_table(kind);
    return table;
}

const KindTable& kind_table(core::CellKind kind) {
    switch (kind) {
    case core::CellKind::tetrahedron: return table_of<core::CellKind::tetrahedron>();
    case core::CellKind::pyramid: return table_of<core::CellKind::pyramid>();
    case core::CellKind::wedge: return table_of<core::CellKind::wedge>();
    case core::CellKind::hexahedron: break;
    }
    return table_of<core::CellKind::hexahedron>();
}

} // namespace

const PieceCase& piece_case(core::CellKind kind, unsigned inside, bool of_upper) {
    return kind_table(kind)[of_upper][inside];
}

} // namespace isotet::solid
