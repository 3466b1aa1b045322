// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which functions a cell has, of which nodes, and where the tets that it is split into lie in it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>

#include "grid/cells.hpp"
#include "linear/curved/high_degree.hpp"
#include "linear/curved/node_values.hpp"
#include "linear/curved/own_functions.hpp"
#include "linear/curved/quadratic.hpp"

namespace isotet::linear {

struct OwnCell {
    const OwnFunctions* functions = nullptr; ///< null: the quadratic tets are what the cell is
    core::CellKind kind{};
    std::vector<Node> nodes;            ///< mean_node: half of both ends of that edge
    std::array<CellPlace, 8> corners{}; ///< of the part of the cell that was split into tets

    /// At all nodes.
    void values(const NodeValues& of, std::vector<double>& out) const;
    /// The two nodes of which node `i`, a mean_node, is the mean.
    std::array<Node, 2> ends(std::size_t i) const;
};

/// Finds the OwnCell of a cell of `before`. One thread each; borrows all.
class OwnCells {
public:
    /// `user`   sound
    OwnCells(const Grid& user, const LinearGrid& before, const QuadraticTets& tets);

    void find(std::uint64_t cell, OwnCell& out);

private:
    const QuadraticTets& tets_;
    core::CellReader users_;
    const Array& source_cells_;
    std::map<HighDegree, DegreePlan> plans_;
};

/// A place of a tet as one of its cell.
CellPlace place_in_cell(const std::array<std::uint32_t, 4>& steps, const std::array<CellPlace, 4>& corners);

} // namespace isotet::linear
