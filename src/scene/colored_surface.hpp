// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces that carry the field which colours them.
#pragma once

#include <isotet/isosurface_scene.hpp>
#include <isotet/progress.hpp>

namespace isotet::scene {

/// The first field of points or cells, as `field` is one, with its scale.
SurfaceColors carried_colors(const Surface& surface, const ColorField& field);

} // namespace isotet::scene
