// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Values inside a Lagrange pyramid, from those at its nodes.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include <isotet/export.hpp>

#include "grid/cell/node_order.hpp"

namespace isotet::linear {

/// The space of a pyramid of degree p: the polynomials of degree p, and rational functions that are polynomials of degree p
/// on every face (Bergot, Cohen, Duruflé 2010; Gmsh's). With a = x / (1 - z), b = y / (1 - z) it is spanned by
/// (1 - z)^max(i, j) a^i b^j z^k, k at most p - max(i, j).
///
/// Method   Newton's, layer by layer from the base: the function of a node is 0 at the other nodes of its layer and on all
///          layers below, so the weights follow from the top down without inverting a matrix.
class ISOTET_API PyramidWeights {
public:
    explicit PyramidWeights(unsigned degree);

    /// Of the nodes in VTK's order, at `place` / `steps` inside the cell.
    std::vector<double> at(const core::LatticePlace& place, unsigned steps) const;
    /// The same at x, y, z of the unit pyramid, of which the base is a square from 0 to 1.
    std::vector<double> at(const std::array<long double, 3>& place) const;

private:
    std::vector<double> weights(const std::array<long double, 3>& place, long double steps) const;

    unsigned degree_;
    std::vector<core::LatticePlace> nodes_;
    std::vector<std::size_t> from_top_;        ///< nodes by layer
    std::vector<std::vector<long double>> of_; ///< [node]: the functions of all nodes on layers below it, there
};

} // namespace isotet::linear
