// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Lagrange and Bezier cells of degree 1: the linear cells that they are.
#pragma once

#include <cstdint>
#include <optional>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>

#include "grid/cell/cell_kind.hpp"

namespace isotet::core {

inline constexpr std::uint8_t first_lagrange = 71; ///< tetrahedron, hexahedron, wedge, pyramid
inline constexpr std::uint8_t first_bezier = 78;   ///< the same

/// The linear type with the same nodes in the same order of a Lagrange or Bezier cell with nodes at its corners alone.
constexpr std::optional<std::uint8_t> linear_name_of(std::uint8_t type, std::uint64_t nodes) {
    constexpr std::uint8_t types[] = {10, 12, 13, 14}, corners[] = {4, 8, 6, 5};
    for (const std::uint8_t first : {first_lagrange, first_bezier})
        if (type >= first && type < first + 4 && nodes == corners[type - first]) return types[type - first];
    return std::nullopt;
}

/// True when some cells have linear_name_of(). Offsets that do not fit the types: false.
/// Cost   a parallel pass over the types, and over the offsets where there are Lagrange or Bezier cells
ISOTET_API bool has_linear_names(const Cells& cells);

/// The same cells, these by their linear types.
ISOTET_API Cells with_linear_names(Cells cells);

} // namespace isotet::core
