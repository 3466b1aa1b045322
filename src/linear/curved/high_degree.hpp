// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells of degree 3 and above, and Bezier cells, as cells of degree 2 on a lattice.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>

#include "grid/cells.hpp"
#include "linear/curved/curved_kinds.hpp"
#include "linear/parts.hpp"

namespace isotet::linear {

/// How every cell of one kind and degree p is split: into cells of degree 2, ceil(p / 2) along each edge.
struct DegreePlan {
    struct Cell {
        std::uint8_t type;
        std::vector<std::uint32_t> places;
    };
    using Terms = std::vector<std::pair<std::uint16_t, double>>; ///< a node of the cell and its weight

    std::vector<Terms> rows; ///< for each place; one term: that node. Empty: no place of the cell
    std::vector<Cell> cells;
};

/// Weights on faces are rational numbers, rounded once: the same for both cells of a face.
DegreePlan plan_of(const HighDegree& cell);

/// One cell at a time.
class HighDegreeSplitter {
public:
    explicit HighDegreeSplitter(const core::CellReader& cells) : cells_(cells) {}

    /// Adds the parts of a cell of high_degree_of(). Points of two cells that share a face are made twice: merge_rows().
    void split(std::size_t cell, const HighDegree& what, Parts& out);

private:
    const core::CellReader& cells_;
    std::map<HighDegree, DegreePlan> plans_;
    std::vector<std::uint64_t> corner_of_place_, corners_, points_;
    std::vector<double> weights_;
};

/// Derived points of the same points and weights become one, numbered by their first.
void merge_rows(LinearGrid& grid);

/// True when there is a cell that HighDegreeSplitter splits.
bool has_high_degree(const core::CellReader& cells);

/// What is wrong with the points of a cell of high_degree_of(); empty: nothing.
std::string fault_of_high_degree(const Grid& grid, const core::CellReader& cells, std::size_t cell);

} // namespace isotet::linear
