// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells that are folded over.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>

#include "linear/curved/node_values.hpp"
#include "linear/curved/quadratic.hpp"

namespace isotet::linear {

/// Of the cells of some of the tets, how many have a map whose determinant has both signs, by samples.
std::size_t folded_cells(const Grid& user, const LinearGrid& before, const QuadraticTets& tets,
                         const std::array<NodeValues, 3>& points, std::span<const std::uint32_t> of_tets);

} // namespace isotet::linear
