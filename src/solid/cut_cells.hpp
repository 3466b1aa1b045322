// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which cells lie between two isovalues, and the pieces of those that an isovalue cuts.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>

#include "base/buffer.hpp"
#include "grid/cells.hpp"
#include "grid/orientation.hpp"
#include "solid/boundary_faces.hpp"
#include "solid/cap.hpp"
#include "solid/cell_pieces.hpp"
#include "solid/edge_vertices.hpp"
#include "solid/rim.hpp"
#include "solid/warped_face.hpp"

namespace isotet::solid {

/// Flags of a point at two isovalues. Of several points they are ORed.
namespace point_flag {
constexpr std::uint8_t below = 0x01;
constexpr std::uint8_t inside = 0x02;
constexpr std::uint8_t above = 0x04;
constexpr std::uint8_t tied = 0x08; ///< to the lower isovalue and inside, or to the upper one and above
constexpr std::uint8_t no_data = 0x10;
} // namespace point_flag

/// What stays the same for all isovalues.
struct CellFacts {
    core::Buffer<std::uint8_t> in_cell;  ///< of each point: 1 where a regular cell with data has it
    std::vector<std::uint64_t> irregular; ///< cells with repeated corners, ascending
};

/// `values`   one scalar a point: cells with a corner that is NaN do not count
/// Cost       a pass over the cells; a byte a point
CellFacts facts_of(const core::CellReader& cells, const Array& values, const Progress& progress);

/// Faces of the boundary that are not flat. They are in no other cell, so a vertex inside each of their parts disturbs none.
struct WarpedFaces {
    BoundaryFaces boundary; ///< these faces, by cell ascending
    BoundaryPoints points;
};

/// An isosurface by its vertices.
struct CutLevel {
    EdgeVertices vertices;
    core::PointReader positions; ///< in the surface's order
};

/// Numbers of what may become points: those of the grid, vertices of the lower isosurface, of the upper one, then vertices
/// inside faces (Cap::apexes).
struct Places {
    std::uint64_t points = 0, lower = 0, upper = 0, apexes = 0;

    std::uint64_t first_lower() const { return points; }
    std::uint64_t first_upper() const { return points + lower; }
    std::uint64_t first_apex() const { return points + lower + upper; }
    std::uint64_t count() const { return points + lower + upper + apexes; }
};

struct CutInput {
    const Grid& grid; ///< linear cells
    const core::CellReader& cells;
    const CellFacts& facts;
    core::Buffer<std::uint8_t> flags; ///< of points
    CutLevel lower, upper;
    Places places;
    double flat_within = 0;              ///< quadrilaterals of the isosurface are flat where no vertex is farther off
    const WarpedFaces* warped = nullptr; ///< null: not looked for yet
    Cap cap;                             ///< of these
    std::vector<std::uint32_t> first_apex; ///< of each of these; one more than faces
};

constexpr std::size_t clip_block = 1 << 12; ///< cells

/// The pieces in some cells that follow each other.
struct BlockPieces {
    std::vector<std::uint16_t> cells;          ///< in the block, one a piece, ascending
    std::vector<std::uint8_t> types, sizes;    ///< one a piece; corners
    std::vector<std::uint16_t> face_entries;   ///< one a piece: in `faces`
    std::vector<std::uint32_t> corners, faces; ///< places; faces as Cells has them
    std::uint64_t whole_cells = 0, whole_corners = 0, cut_cells = 0, polyhedra = 0, flat = 0;
};

struct CutCells {
    std::vector<BlockPieces> blocks;     ///< of clip_block cells each
    core::Buffer<std::uint8_t> is_whole; ///< of each cell
    core::Buffer<std::uint8_t> used;     ///< of each place
    bool needs_warped = false;           ///< some cell is cut where a face is warped: nothing else counts before
                                         ///< CutInput::warped is known
};

/// Guarantees   the same for any thread count
/// Cost         a pass over the cells; a byte a cell and place, and the pieces
CutCells cut_cells(const CutInput& input, const Progress& progress);

} // namespace isotet::solid
