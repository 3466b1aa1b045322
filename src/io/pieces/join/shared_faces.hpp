// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Faces that several polyhedra share, as files store them, as the stream that a grid has (Cells::faces).
#pragma once

#include <cstdint>

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

/// The checks of write_out_faces().
ISOTET_API Result<void> check_shared_faces(const SharedFaces& shared);

/// Writes every face out in each of its cells, as int32 where the points are int32.
///
/// Errors   invalid_data: other types, offsets that fall or leave their list, a face that is not there, faces that are
///          shared so often that a small file would fill any memory. Numbers of points are not looked at
/// Cost     O(n), all threads
ISOTET_API Result<void> write_out_faces(const SharedFaces& shared, Cells& cells);

/// Gives cells with faces the points of these as corners, ascending, in place of those they have. Types and offsets must be
/// there.
///
/// Errors   invalid_data: as core::fault_of_faces(); offsets that fall or leave the connectivity
/// Cost     O(n log n) in the size of a cell, all threads
ISOTET_API Result<void> list_points_of_faces(std::uint64_t points, Cells& cells);

} // namespace isotet::io
