// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which triangles use a vertex: the index that everything around vertices and edges is found with.
#pragma once

#include "check/mesh.hpp"
#include "grid/values/incidence.hpp"

namespace isotet::checking {

template <class Index>
using Stars = core::Incidence<Index>;

/// The triangles around every vertex, those with equal corners left out.
template <class Index>
Stars<Index> stars_of(const Mesh& mesh) {
    return {mesh.vertex_count(), mesh.triangles(), [&](std::uint64_t triangle, const auto& body) {
                const Corners corners = mesh.corners(triangle);
                if (has_equal_corners(corners)) return;
                for (const std::uint64_t vertex : corners) body(vertex);
            }};
}

} // namespace isotet::checking
