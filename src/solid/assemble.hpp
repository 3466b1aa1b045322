// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One surface of isosurfaces and the boundary's part, with what each carries.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/surface.hpp>

#include "solid/cap.hpp"

namespace isotet::solid {

/// An isosurface of a solid.
struct Shell {
    Surface surface;       ///< with edge ends
    bool mirrored = false; ///< its triangles face into the solid
};

/// The vertices of the shells, then those of the cap; the triangles likewise. Arrays that `options` do not ask for are
/// left out.
///
/// `input`              linear cells: what new vertices and triangles carry
/// `user_cell_fields`   of the user's cells: what 2D cells on the boundary have
Surface assemble(std::span<const Shell> shells, const Cap& cap, const ContourInput& input,
                 const std::vector<Field>& user_cell_fields, const ContourOptions& options);

/// The volume that a closed surface encloses, and the area of the triangles [first, last): summed in a fixed order.
double enclosed_volume(const Surface& surface);
/// The same of what lies between a point and the triangles: of a part of a closed surface its share.
double enclosed_volume(const Surface& surface, const std::array<double, 3>& middle);
double area_of(const Surface& surface, std::size_t first, std::size_t last);

/// The area of each of these.
std::vector<double> areas_of(const Surface& surface, std::size_t first, std::size_t last);

} // namespace isotet::solid
