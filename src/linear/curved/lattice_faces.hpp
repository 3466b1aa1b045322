// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polyhedra beside cells of degree 3 and above: with the points of these on common edges and faces.
#pragma once

#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"

namespace isotet::linear {

/// True when a polyhedron has both ends of an edge of a cell that is split into several along each edge.
/// Cost   a pass over the cells, a byte a point
bool has_polyhedra_at_lattices(const core::CellReader& cells, const core::FaceReader& faces);

/// The cells of `split` with the faces of polyhedra. A face that a cell of degree 3 and above has, too, becomes the faces
/// of the quadratic cells that it was split into, and an edge takes their corners; linear cells become polyhedra for it.
///
/// `cells`, `faces`   of the user
/// `split`            of these, cells of degree 3 and above as quadratic ones, all others as they are, but without faces
/// Errors             out_of_memory; cancelled
Result<Cells> with_lattice_faces(const core::CellReader& cells, const core::FaceReader& faces, const LinearGrid& split,
                                 const Progress& progress);

} // namespace isotet::linear
