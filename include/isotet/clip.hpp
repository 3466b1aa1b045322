// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The part of a grid on one side of an isosurface, or between two of them, as a grid.
#pragma once

#include <cstdint>
#include <memory>

#include <isotet/array.hpp>
#include <isotet/contour.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/solid.hpp>

namespace isotet {

struct ClipOptions {
    bool polyhedra = true; ///< false: pieces that would be are split around a point inside, as by linearize()
};

/// Cells between isovalues.
///
/// `grid`          cells in the order of those they come from; points of the grid ascending, those at edges that isovalues
///                 cross, then those inside faces that are not flat; only such as cells use. Points are float32 or float64 as
///                 those of surfaces, indices int32 where they fit, else int64. Fields are those of the input: point
///                 fields as surfaces carry them, cell fields in their own type
/// `source_cells`  with ContourOptions::source_cells: int64, the user's number of the cell that each comes from
/// `edge_ends`, `edge_weights`   with ContourOptions::edge_ends: as Surface has them, one a point; a point of the grid is both
///                 ends, one inside a face or cell has -1
struct ClippedGrid {
    Grid grid;
    Array source_cells;
    Array edge_ends;
    Array edge_weights;
    std::uint64_t whole_cells = 0; ///< of the grid, kept as they are
    std::uint64_t cut_cells = 0;   ///< of the grid
    std::uint64_t polyhedra = 0;   ///< of the pieces of these
    std::uint64_t flat_pieces = 0; ///< left out: at ties, all that is inside of a cell may be a face of it
    std::uint64_t folded_pieces = 0; ///< without polyhedra: pieces that no point sees from inside, some of whose cells are
                                     ///< inside out
    ContourResult contour;           ///< of the isosurfaces; its surfaces are empty
};

/// Clips one grid by one field, for one range of values after another.
///
/// Cells with all corners in the range are kept as they are; cells with a corner that is NaN are left out. Others are cut where
/// isosurfaces cross their edges: their faces are cut into the polygons that the isosurface cuts off, the same in both cells of a
/// face, and closed by the isosurface's triangles. A piece is a tetrahedron, pyramid, wedge or hexahedron where it has that
/// shape, where the isosurface in it is flat up to rounding, or else a polyhedron, faces outwards.
/// Polyhedra and curved cells of the grid are taken as linear cells, as by Solids.
///
/// Threads   one call at a time
class ISOTET_API Clipper {
public:
    /// `options`   as of Solids; no normals. Cells that are split are tetrahedra in the result, whole or cut
    /// Cost        a session, and two passes over the cells
    /// Errors      as Solids::create()
    static Result<Clipper> create(ContourInput input, const ContourOptions& options = {}, const Run& run = {});

    Clipper(Clipper&&) noexcept;
    Clipper& operator=(Clipper&&) noexcept;
    ~Clipper();

    /// The cells where range.lower <= field < range.upper.
    ///
    /// Guarantees   the same bytes for any thread count and method; the boundary is Solids::extract() of the same range, vertex
    ///              by vertex, but for pieces without a volume, of which a solid has both sides; conforming where the grid is
    /// Cost         as Contour::extract(), a pass over points and cells, and what is copied. The first cell that is cut where a
    ///              quadrilateral is not flat costs a look for the boundary, once
    /// Errors       invalid_argument when no end of the range is finite, or lower >= upper; invalid_data from 2^32 points on,
    ///              those of the grid and of the isosurfaces together; out_of_memory, before it is taken; as Contour::extract()
    Result<ClippedGrid> clip(const SolidRange& range, const ClipOptions& options = {}, const Run& run = {});

    /// The range of the field, as Contour::field().
    Result<FieldReport> field(const Run& run = {});

    /// The method of the isosurfaces, as Contour::method().
    Method method() const;

    /// The linear cells that were made of the grid; null where all its cells are linear.
    std::shared_ptr<const LinearGrid> linear_grid() const;

private:
    struct Data;
    explicit Clipper(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

} // namespace isotet
