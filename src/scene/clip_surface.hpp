// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cutting surfaces by planes.
#pragma once

#include <isotet/isosurface_scene.hpp>
#include <isotet/surface.hpp>

namespace isotet::scene {

/// What of a surface lies at normal . p <= offset. Triangles that the plane cuts end there; their new vertices have the
/// values between those of both ends. Normals of faces, edge ends and source cells are dropped.
Surface clipped(const Surface& surface, const Plane& plane);

/// The edges of the triangles, each once.
DrawnLines edges_of(const Surface& surface);

} // namespace isotet::scene
