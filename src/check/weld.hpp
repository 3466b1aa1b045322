// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Giving triangles that were stored without shared vertices (STL, surfaces of pieces) their shared vertices.
#pragma once

#include <cstdint>

#include "check/mesh.hpp"

namespace isotet::checking {

struct Welded {
    Surface surface;             ///< positions, triangles and edge ends only
    std::uint64_t collapsed = 0; ///< triangles that had three vertices, at fewer than three places: left out
};

/// Makes one vertex, the lowest, of all on the same edge of the grid where the surface has edge ends, else of all at
/// exactly the same place (-0 equals +0). Vertices keep their order.
Welded weld(const Surface& surface, const Mesh& mesh);

} // namespace isotet::checking
