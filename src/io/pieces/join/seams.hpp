// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which points of different pieces of a grid are one.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/pieces/join/piece_points.hpp"

namespace isotet::io {

/// The points of a piece.
struct SeamPiece {
    Array points;                  ///< float32 or float64, 3 components
    Array ids;                     ///< empty, or a global number for each
    std::span<const PointUse> use; ///< empty: all are used; points of no kept cell are joined with none
    Box box;                       ///< box_of() them
};

/// A point that is one with a point of an earlier piece. Points are counted through all pieces.
struct JoinedPoint {
    std::uint64_t point, first;
};

enum class IdUse : std::uint8_t {
    missing,  ///< not all pieces have global numbers
    trusted,  ///< the same number means the same place, and they decide
    unshared, ///< no two pieces have a number in common
    wrong     ///< a number means different places
};

struct Seams {
    std::vector<JoinedPoint> joined; ///< ascending by point; `first` is joined with no point before it
    IdUse ids = IdUse::missing;
    std::uint64_t apart = 0; ///< points at the place of another piece's, with which they were not joined
    std::uint64_t near = 0;  ///< points within a millionth of the grid's length of another piece's
    double gap = 0;          ///< the largest distance of these from the nearest such point
};

/// Finds the points of different pieces at one place.
///
/// Places are one when they differ by a few roundings of the coordinates' type, or when other points lie between. Two
/// points of one piece are never joined: where a piece has several points at a place, its nearest is taken if both are
/// each other's nearest, and none where that is a tie. Global numbers that are trusted decide instead of coordinates.
///
/// Guarantees   the same points are joined in any order of pieces, on any number of threads
/// Errors       out_of_memory; cancelled
/// Cost         one pass over the points; sorting those that lie in the box of another piece, 150 bytes each; with
///              global numbers sorting all, 32 bytes each
Result<Seams> find_seams(const std::vector<SeamPiece>& pieces, const Progress& progress);

} // namespace isotet::io
