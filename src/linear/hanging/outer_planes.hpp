// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <isotet/array.hpp>

#include "linear/hanging/face_shapes.hpp"
#include "linear/hanging/open_faces.hpp"

namespace isotet::linear {

/// Whether the faces lie in few planes, and no point of the grid is beyond one: no cell is behind such a face. Planes are
/// fitted, and hold what rounding of coordinates may have put beside them.
///
/// `shapes`   of the faces
/// Cost       up to the first point that is beyond: a pass over the points, a distance for each plane
bool are_outermost(const OpenFaces& faces, const FaceShapes& shapes, const Array& points);

} // namespace isotet::linear
