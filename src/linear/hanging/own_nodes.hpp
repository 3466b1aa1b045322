// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Nodes of curved cells on edges, where these cells list hanging points and so become polyhedra.
#pragma once

#include <cstdint>
#include <vector>

#include "grid/cells.hpp"
#include "linear/hanging/split_edges.hpp"

namespace isotet::linear {

/// The nodes on edges of some cells, but for edges that another curved cell has, whose points all cells with the edge
/// take when curved cells are refined, for edges with points on them, and for those on which two cells have other nodes.
/// The nodes of Bezier cells are none of their points.
///
/// `cells`    of the grid, curved ones as they are
/// `listed`   cells that become polyhedra, ascending
/// Cost       a pass over the cells, a byte a point
std::vector<PointOnEdge> own_nodes(const core::CellReader& cells, const std::vector<std::uint64_t>& listed,
                                   const SplitEdges& split);

} // namespace isotet::linear
