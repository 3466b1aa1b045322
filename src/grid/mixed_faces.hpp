// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where cells of different kinds do not fit: a quadrilateral face of one that meets triangles of others.
#pragma once

#include <cstdint>

#include <isotet/progress.hpp>

#include "grid/cells.hpp"

namespace isotet::core {

/// Quadrilateral faces that no other cell has as its own, but with three corners of which some triangular face is.
/// Native cells draw lines on the two sides of such a face by different rules, and the surface may be open there.
///
/// `memory`     bytes that it should not take more of: where that is little, in several passes over the cells
/// Guarantees   the same count for any thread count and any `memory`; 0 when cancelled
/// Cost         nothing for grids of one kind that has only triangles or only quadrilaterals; else a pass over the cells
///              and sorting of their faces, 32 bytes each, twice at a time
std::uint64_t count_quads_on_triangles(const CellReader& cells, std::uint64_t memory, const Progress& progress);

} // namespace isotet::core
