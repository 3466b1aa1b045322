// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/extract.hpp>
#include <isotet/grid.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

struct DirectOptions {
    ExtractOptions extract = {};              ///< whatever it asks for can be had: nothing need have been kept for it
    Precision precision = Precision::float32; ///< of positions, values and weights
    bool split_cells = false;                 ///< as PackOptions::split_cells
    std::optional<Frame> frame = {};          ///< as PackOptions::frame
    bool active_cells_only = false;           ///< the grid has only what an ActiveCellFilter kept (active_cells.hpp)
};

/// Surfaces from arrays, and what was seen on the way.
struct DirectExtraction {
    std::vector<Extraction> surfaces; ///< in the order of the isovalues; no clusters are selected
    FieldReport field;
    std::uint64_t cells_left_out = 0; ///< cells of types that are not contoured
    std::uint64_t coarse_tets =
        0; ///< active tets and other cells (of all isovalues) where rounding to float32 moves a corner by over
           ///< a thousandth of the shortest edge
    bool needs_all_cells = false; ///< with DirectOptions::active_cells_only: cells that were not kept decide how values
                                  ///< are stored, or which side of a flat tet is which; there are no surfaces
};

/// Extracts surfaces straight from the arrays of a grid; nothing is kept. For one isovalue or a few: many are faster
/// from a packed grid (extract.hpp), whose surfaces these are, in another order.
///
/// `grid`, `field`  as for pack()
/// `isovalues`      in the unit of the field; finite; in any order, with repetitions; none at all: only the report is
///                  made
///
/// Guarantees   the vertices and triangles of extract() on the packed grid, except that a repeated cell gives its
///              triangles again; triangles by the user's cells ascending, tets of a split cell in the order of split();
///              vertices by the lower, then the higher point number of their edge, a vertex at a tied point before
///              those on edges from it; gradient normals may differ in the last place, being summed in the user's order
///              of the tets; the same bytes for any thread count and on every engine
/// Cost         one pass over cells and points for each isovalue, and what its surface takes; gradient normals another
///              two. Transient memory: a byte a point; about 50 bytes a triangle where cells that are neighbours are
///              near each other in the arrays, 110 where they are shuffled
/// Errors       invalid_argument when an isovalue is not finite or a field does not fit grid or frame; invalid_data
///              as survey();
///              out_of_memory, before memory is taken, with the amount needed and the amount free; cancelled
/// Threads      safe from many threads on one grid
/// Method       marching cells over all cells, welded by sorted edges; docs/inside/direct.md
ISOTET_API Result<DirectExtraction> extract_direct(const Grid& grid, const PointField& field,
                                                   std::span<const double> isovalues, const DirectOptions& options = {},
                                                   const Run& run = {});

} // namespace isotet
