// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Area and volume, summed in an order that does not depend on threads.
#pragma once

#include <cstdint>
#include <vector>

#include "check/mesh.hpp"

namespace isotet::checking {

struct Measures {
    double area = 0;
    double volume = 0; ///< by the divergence theorem, relative to a vertex of the surface
    std::uint64_t zero_area = 0; ///< triangles with three different corners and an area of exactly zero
    std::vector<std::uint64_t> zero_area_list; ///< the first `most` of them
};

/// Triangles with equal corners add nothing.
Measures measure(const Mesh& mesh, std::size_t most);

} // namespace isotet::checking
