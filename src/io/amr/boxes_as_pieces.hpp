// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Overlapping boxes of cells on several levels (AMR) as pieces of one grid of hexahedra.
#pragma once

#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/amr/lattice.hpp"
#include "io/pieces/loaded.hpp"
#include "io/reader.hpp"

namespace isotet::io::amr {

/// What to read of boxes: cell fields that are wanted at points, too.
ISOTET_API ReadOptions options_of_boxes(const ReadOptions& options);

/// Announces a point field for each cell field that has none of its name.
ISOTET_API void announce_point_values(FileInfo& info);

/// Adds to the pieces what their boxes are: points, hexahedra, numbers by which equal points are joined, marks of cells
/// under finer ones, and values of cell fields at points (add_point_values()), where `options` want them.
///
/// `loaded.pieces`   one a box, level by level, with fields as options_of_boxes() wants them, and marks of what the
///                   file leaves out
/// Errors            as Lattice::make(), mark_covered(); out_of_memory; cancelled
ISOTET_API Result<void> boxes_as_pieces(const Hierarchy& hierarchy, const ReadOptions& options, Loaded& loaded,
                                        const Progress& progress);

} // namespace isotet::io::amr
