// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Quadratic tets so small that they are near the cells' own functions.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "linear/curved/bisection.hpp"
#include "linear/curved/node_values.hpp"
#include "linear/curved/quadratic.hpp"

namespace isotet::linear {

struct OwnRule {
    double value = 0;                            ///< how far the field should be from the cell's own at most
    double length = 0;                           ///< the same for places; 0: this share of a tet's longest edge:
    double share = 0.005;                        ///<
    std::span<const double> isovalues;           ///< ascending; tets that none can meet are dropped; empty: none is
    std::span<const CarriedValues> carried = {}; ///< for which tets are bisected, too, to a quarter of their edges
};

/// How far quadratic tets are from the cells' own functions, proven.
struct OwnBounds {
    std::vector<double> value, length; ///< one a quadratic tet; empty: 0
    double expected = 0;               ///< of the field in all cells, whatever the isovalues: by estimate
};

/// Bisects tets of cells whose own functions differ more than they should from the quadratic interpolants, at first marked
/// edges: those longer than 2^-level in weights of the tet's corners, the longest first. The level of an edge is the least
/// of the points on whose tet's edge, face or inside it is; that of a point the highest of its cells. So
/// neighbours agree, and isovalues play no part.
///
/// New corners and middles become derived points of `before`: its cells are not, so only its points are to be used after it.
///
/// `user`    the grid before polyhedra and cells of degree 3 and above were split
/// `field`   at the points of `before`
Result<OwnBounds> follow_own_functions(const Grid& user, LinearGrid& before, QuadraticTets& tets,
                                       const NodeValues& field, const std::array<NodeValues, 3>& points,
                                       const OwnRule& rule, const Progress& progress);

} // namespace isotet::linear
