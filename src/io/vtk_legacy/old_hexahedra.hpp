// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Lagrange and Bezier hexahedra in files of VTK 8: two of the upright edges stood the other way round.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <isotet/grid.hpp>

#include "grid/cell/node_order.hpp"

namespace isotet::io {

/// Puts their nodes into the order of VTK 9. For XML files before version 2.1, legacy files before 5.1.
inline void reorder_old_hexahedra(Cells& cells) {
    constexpr std::uint8_t lagrange = 72, bezier = 79;
    if (cells.types.empty() || cells.offsets.empty()) return;
    const auto is_old = [](std::uint8_t type) { return type == lagrange || type == bezier; };
    const auto types = cells.types.as<std::uint8_t>();
    if (std::ranges::none_of(types, is_old) || cells.offsets.tuples() != types.size() + 1) return;
    cells.connectivity = cells.connectivity.visit([&]<class Index>(std::span<const Index> from) {
        std::vector<Index> to(from.begin(), from.end());
        for (std::size_t cell = 0; cell < types.size(); ++cell) {
            const double begin = cells.offsets.at(cell), end = cells.offsets.at(cell + 1);
            if (!is_old(types[cell]) || begin < 0 || end < begin || end > static_cast<double>(to.size())) continue;
            const unsigned degree =
                core::degree_of(core::CellKind::hexahedron, static_cast<std::uint64_t>(end - begin));
            if (degree < 2) continue;
            const auto inside = static_cast<std::ptrdiff_t>(degree) - 1;
            const auto edge =
                to.begin() + static_cast<std::ptrdiff_t>(begin) + 8 + 10 * inside; // the third upright one
            std::swap_ranges(edge, edge + inside, edge + inside);
        }
        return Array::own(std::move(to));
    });
}

} // namespace isotet::io
