// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "grid/cell/cell_cases.hpp"

namespace isotet::reference {

/// The triangles of a cell, by the edges on which their corners lie.
inline std::vector<std::array<core::ActiveEdge, 3>> triangles_of(core::CellKind kind, unsigned index) {
    std::vector<std::array<core::ActiveEdge, 3>> triangles;
    const auto add = [&](const std::array<core::ActiveEdge, 4>& polygon, std::size_t count) {
        for (std::size_t t = 0; t < count; ++t) {
            const auto& corner = core::triangle_corners[t];
            triangles.push_back({polygon[corner[0]], polygon[corner[1]], polygon[corner[2]]});
        }
    };
    if (kind == core::CellKind::tetrahedron) add(core::case_table[index].polygon, core::case_table[index].triangles);
    else
        for (const core::CellPolygon& polygon : core::polygons_of(kind, index)) add(polygon.edges, polygon.triangles);
    return triangles;
}

} // namespace isotet::reference
