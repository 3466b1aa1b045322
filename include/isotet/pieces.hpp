// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cutting grids into pieces, and what makes pieces fit beside the frame (frame.hpp): numbers of points that pieces
// share, and cells that are counted in one piece only.
#pragma once

#include <cstdint>

#include <isotet/array.hpp>
#include <isotet/contour.hpp>
#include <isotet/export.hpp>
#include <isotet/frame.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet {

/// The cells [first, last) as a grid of their own: only the points that they use, in the order of the whole grid, with
/// Grid::point_numbers telling their numbers there (those that the grid has, or else its point indices). Fields come
/// along.
///
/// Errors   invalid_argument when first > last or last is beyond the cells; invalid_data as survey(); out_of_memory
ISOTET_API Result<Grid> take_cells(const Grid& grid, std::uint64_t first, std::uint64_t last, const Run& run = {});

/// Which of how many.
struct PieceOf {
    std::uint64_t piece = 0; ///< from 0
    std::uint64_t pieces = 1;
};

/// A piece of a grid that is cut by the order of its cells into pieces of equally many cells, the first ones with one
/// more where that does not come out even.
/// Errors   invalid_argument when `piece` is not below `pieces`; otherwise as take_cells()
ISOTET_API Result<Grid> take_piece(const Grid& grid, const PieceOf& which, const Run& run = {});

/// The number of the first cell of a piece.
ISOTET_API std::uint64_t first_cell_of(const Grid& grid, const PieceOf& which) noexcept;

/// As survey_piece() (frame.hpp), of what a session will contour: the field and the carried fields, Survey::max_fields at
/// most, also at the derived points of polyhedra (linear_cells.hpp).
/// Errors   as survey_piece() and linearize()
ISOTET_API Result<Survey> survey_piece(const ContourInput& piece, const SurveyPieceOptions& options = {},
                                       const Run& run = {});

/// A piece of what a session contours, and the frame of the whole.
struct FramedPiece {
    ContourInput input; ///< its fields are those of the piece
    Frame frame;
    std::uint64_t first_cell = 0; ///< the number of the piece's first cell in the whole grid
};

/// As take_piece(), with all fields; for one machine that reads the whole and extracts a part.
/// Errors   as take_cells() and survey_piece()
ISOTET_API Result<FramedPiece> take_piece(const ContourInput& whole, const PieceOf& which,
                                          const SurveyPieceOptions& options = {}, const Run& run = {});

/// The surface of a piece with edge ends and source cells as in the whole grid: two vertices of different pieces are
/// the same when their edge ends are.
///
/// `point_numbers`   of the piece's own points; empty: edge ends stay. Ends in derived points of polyhedra get numbers
///                   from 2^62 on, other ones in each piece
/// `first_cell`      of the piece in the whole grid: is added to source cells
ISOTET_API Result<Surface> number_as_whole(const Surface& surface, const Array& point_numbers,
                                           std::uint64_t first_cell = 0);

/// Numbers for Grid::point_numbers where a grid has none: the rank of each point by x, then y, then z. Two pieces rank
/// the points that they share alike. Points with equal coordinates are ranked by their index.
///
/// Cost     O(P log P), 40 bytes a point
/// Errors   invalid_data when the points are not float32 or float64 with 3 components; out_of_memory
ISOTET_API Result<Array> number_points_by_coordinates(const Array& points, const Run& run = {});

/// The same grid without some of its cells, which keep their numbers: they become cells of a type that is not
/// contoured.
///
/// `marks`    one integer a cell, a ghost array of VTK for example
/// `bits`     a cell goes where its mark has one of these bits; VTK's vtkGhostType: 1 another piece's, 8 refined,
///            16 outside, 32 hidden
/// Errors     invalid_argument when the marks are no integers, or not one a cell
ISOTET_API Result<Grid> leave_out_cells(const Grid& grid, const Array& marks, std::uint64_t bits = 57,
                                        const Run& run = {});

/// A surface without the triangles of some cells, and without the vertices that only these used: for surfaces of
/// pieces with ghost cells, which gradient normals need.
///
/// `surface`  with source cells
/// `marks`, `bits`  as of leave_out_cells()
/// Errors     invalid_argument when the surface has no source cells, or one that has no mark
ISOTET_API Result<Surface> leave_out_triangles(const Surface& surface, const Array& marks, std::uint64_t bits = 57,
                                               const Run& run = {});

} // namespace isotet
