// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Faces that several polyhedra share, as files store them, as the stream that a grid has (Cells::faces).
#pragma once

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/result.hpp>

namespace isotet::io {

/// Integers of 32 or 64 bits, one component, from 0.
struct SharedFaces {
    Array points;       ///< of all faces, one after another
    Array face_offsets; ///< one more than faces: where the points of a face begin
    Array faces;        ///< of all cells, one after another
    Array cell_offsets; ///< one more than cells: where the faces of a cell begin; cells without faces have none
};

/// Writes every face out in each of its cells, as int32 where the points are int32.
///
/// Errors   invalid_data: other types, offsets that fall or leave their list, a face that is not there, faces that are
///          shared so often that a small file would fill any memory. Numbers of points are not looked at
/// Cost     O(n), all threads
ISOTET_API Result<void> write_out_faces(const SharedFaces& shared, Cells& cells);

} // namespace isotet::io
