// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Hanging points: points in the face of a larger cell, which does not have them. The surface is open at such faces.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <isotet/array.hpp>

#include "grid/faces.hpp"

namespace isotet::core {

struct HangingFaces {
    std::uint64_t points = 0; ///< places of hanging points
    /// Those of the given faces that meet smaller ones or a larger one, ascending.
    std::vector<std::array<std::uint64_t, 3>> faces;
};

/// Of the boundary faces of a grid those that lie on one another, one of them larger: a cell's face against several
/// smaller ones.
///
/// A smaller face lies on a larger one when it faces the other way, its centroid is inside, and it has a corner of the
/// larger one or a point in common with another that lies on it. In the larger one's plane; beside it, as at curved
/// shapes, where a point between two corners of the larger face is connected with both. Points at the same place count
/// as one.
///
/// `points`     of the grid
/// Guarantees   the same for any number of threads
/// Cost         O(faces log faces)
/// Errors       cancelled
Result<HangingFaces> find_hanging(const Array& points, const std::vector<BoundaryFace>& faces,
                                  const Progress& progress);

/// The same of a checked grid of linear cells. None where more than 4 million faces, and more than there are tets, are
/// boundary: these are cells that do not meet.
///
/// Errors   cancelled
Result<HangingFaces> find_hanging(const Grid& grid, const CellReader& cells, const Progress& progress);

} // namespace isotet::core
