// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <isotet/grid.hpp>
#include <isotet/result.hpp>

namespace isotet::io {

/// Legacy VTK files have, in place of the corners of a polyhedron, its faces, as Cells::faces has them: moves them there,
/// and puts the points of the faces, each once and in ascending order, into the connectivity.
///
/// `cells`   with offsets and types, which have been checked
/// Errors    invalid_data: the numbers of a polyhedron are no faces
Result<void> take_legacy_polyhedra(Cells& cells);

} // namespace isotet::io
