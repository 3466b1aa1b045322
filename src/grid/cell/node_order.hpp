// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where the nodes of cells of any degree stand in a cell: the orders of VTK's Lagrange cells, of Gmsh and of CGNS.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <isotet/export.hpp>

#include "grid/cell/cell_kind.hpp"

namespace isotet::core {

/// A place on the lattice of a cell of degree p: three numbers from 0 to p. Corner 1 of every kind is at (p, 0, 0). The
/// numbers of a tetrahedron have a sum of at most p, and so have the first two of a wedge; in a pyramid, whose apex is
/// at (0, 0, p), each of the first two has such a sum with the third.
using LatticePlace = std::array<std::uint16_t, 3>;

enum class NodeOrder : std::uint8_t { vtk, gmsh, cgns };

inline constexpr unsigned max_degree = 10;

/// The nodes of a cell, in order. `degree` from 1 to max_degree.
///
/// VTK has no Lagrange pyramids. `vtk` follows its other cells: corners; edges 01, 12, 32, 03, 04, 14, 24, 34; the
/// inside of the base row by row, as of a quadrilateral 0123; of the triangles 014, 124, 234, 304, as of Lagrange
/// triangles; the inside layer by layer from the base, row by row.
ISOTET_API std::vector<LatticePlace> nodes_of_degree(CellKind kind, unsigned degree, NodeOrder order);

/// For each node in VTK's order its position in another one.
ISOTET_API std::vector<std::uint16_t> positions_in(NodeOrder order, CellKind kind, unsigned degree);

/// Their number.
constexpr std::uint64_t node_count(CellKind kind, std::uint64_t degree) {
    const std::uint64_t n = degree + 1;
    switch (kind) {
    case CellKind::tetrahedron: return n * (n + 1) * (n + 2) / 6;
    case CellKind::pyramid: return n * (n + 1) * (2 * n + 1) / 6;
    case CellKind::wedge: return n * n * (n + 1) / 2;
    case CellKind::hexahedron: break;
    }
    return n * n * n;
}

/// The degree up to max_degree of a cell of so many nodes; 0: there is none.
constexpr unsigned degree_of(CellKind kind, std::uint64_t nodes) {
    for (unsigned degree = 1; degree <= max_degree; ++degree)
        if (node_count(kind, degree) == nodes) return degree;
    return 0;
}

} // namespace isotet::core
