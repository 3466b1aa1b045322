// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What each triangle is by itself; area and volume, summed in an order that does not depend on threads.
#pragma once

#include <cstdint>
#include <vector>

#include "check/mesh.hpp"

namespace isotet::checking {

struct Measures {
    double area = 0;
    double volume = 0; ///< by the divergence theorem, relative to a vertex of the surface
    std::uint64_t equal_corners = 0; ///< triangles with fewer than three different corners; they measure nothing
    std::uint64_t zero_area = 0;     ///< all others with an area of exactly zero
    std::vector<std::uint64_t> equal_corners_list, zero_area_list; ///< the first `most` of each
};

Measures measure(const Mesh& mesh, std::size_t most);

} // namespace isotet::checking
