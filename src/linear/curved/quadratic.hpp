// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The cells of a grid as quadratic tets of ten nodes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "base/buffer.hpp"

namespace isotet::linear {

/// A point of the grid; from the number of its points on a row of hidden nodes; or mean_node.
using Node = std::uint32_t;
inline constexpr Node mean_node = 0xffffffff; ///< half of both ends: a straight edge on which fields are linear
inline constexpr std::uint64_t max_nodes = std::uint64_t{1} << 31;

/// The edges of a tet, as pairs of corners: the order of nodes 4 to 9.
inline constexpr std::array<std::array<std::uint8_t, 2>, 6> tet_edges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
/// The number of the edge between two corners.
inline constexpr std::array<std::array<std::uint8_t, 4>, 4> tet_edge_of{
    {{0, 0, 1, 2}, {0, 0, 3, 4}, {1, 3, 0, 5}, {2, 4, 5, 0}}};

/// Four corners, by ascending point number; then what lies in the middle of each edge.
using QuadraticTet = std::array<Node, 10>;

struct QuadraticTets {
    core::Buffer<QuadraticTet> tets;
    core::Buffer<std::uint8_t> odd;      ///< 1: the corners are an odd permutation of those of the upright cell
    core::Buffer<std::uint64_t> sources; ///< the cell of each
    core::Buffer<std::array<std::uint8_t, 4>> locals; ///< which corners of the cell the corners are
    std::vector<std::uint64_t> first_node;            ///< of each cell in cell_nodes, and the end; with CellNodeLists::kept
    std::vector<Node> cell_nodes; ///< the nodes of degree 2 of cells that are no tets, in VTK's order, made ones too
    DerivedPoints hidden;                ///< nodes in the middle of faces and cells, of the grid's points
    std::uint64_t curved = 0;            ///< cells of a curved type that are among them
    std::uint64_t left_out = 0;          ///< cells of all other types
    std::uint64_t unknown = 0;           ///< of these: curved cells of a degree or type that is not handled
};

enum class CellNodeLists : std::uint8_t { left_out, kept };

/// Every linear and curved cell as quadratic tets, in the order of the cells; others are left out.
///
/// Edges without a node take the node that another cell has on that edge, else the mean of their ends; quadrilaterals
/// likewise, else the value of the face of degree 2 without a node of its own: -1/4 of the corners and 1/2 of the edges.
///
/// Errors   invalid_data: a number of nodes that does not fit the type, points out of range or not finite, more points
///          than 2^31, nothing left; cancelled
Result<QuadraticTets> quadratic_tets(const Grid& grid, CellNodeLists lists, const Progress& progress);

} // namespace isotet::linear
