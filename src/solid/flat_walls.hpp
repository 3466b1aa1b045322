// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Walls without thickness: triangles of a solid that lie back to back, where faces of cells have the isovalue, or parts of
// them, and both their sides are in the solid, or neither.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <isotet/surface.hpp>

#include "solid/assemble.hpp"

namespace isotet::solid {

/// Whether a vertex of an isosurface is a point of the grid: without these there are no such walls.
bool has_tied_vertices(std::span<const Shell> shells);

/// Triangles of such walls, ascending. Two of a quadrilateral that is flat lie back to back with two others of it, whichever
/// diagonals they have.
///
/// `solid`    the triangles of the shells, then those of the cap
/// `others`   of cells that belong to other pieces: a triangle of the solid may lie on one of theirs
std::vector<std::uint64_t> triangles_of_flat_walls(const Surface& solid, std::span<const Shell> shells,
                                                   std::span<const Shell> others);

/// The same surface without some triangles, and without vertices that only these used.
///
/// `out`   ascending
Surface without_triangles(const Surface& surface, std::span<const std::uint64_t> out);

} // namespace isotet::solid
