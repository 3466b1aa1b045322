// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/contour.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet {

// The part of a grid on one side of an isosurface, or between two of them, as a closed surface.

/// Where lower <= field < upper, in the unit of the field; at least one of them finite.
struct SolidRange {
    double lower = -std::numeric_limits<double>::infinity();
    double upper = std::numeric_limits<double>::infinity();

    static SolidRange above(double isovalue) { return {isovalue, std::numeric_limits<double>::infinity()}; }
    static SolidRange below(double isovalue) { return {-std::numeric_limits<double>::infinity(), isovalue}; }
};

/// What a triangle of a solid is part of: values of its cell field "boundary".
enum class SolidPart : std::uint8_t { isosurface = 0, boundary = 1 };

/// A named part of the boundary (Grid::patches), and what of it is on a solid.
struct SolidPatch {
    std::int64_t number = 0;
    std::string name;
    std::uint64_t triangles = 0;
    double area = 0;
};

/// A solid and what is told of it.
///
/// `surface`   triangles face outwards: those of the isosurfaces first, in the order of extract(), then the boundary. Its
///             last cell field is "boundary", uint8, a SolidPart. Where the grid has patches, "patch" is their number on the
///             boundary, else -1. Where 2D cells of the grid lie on its boundary, "patch_cell" is the number of the first
///             one, and "patch_NAME" what it has of each carried cell field NAME of whole numbers. Vertices: those of the
///             isosurfaces, then points of the grid (both edge ends are the point), then vertices inside faces that are
///             not flat (both are -1)
struct Solid {
    Surface surface;
    std::uint64_t isosurface_triangles = 0;
    double volume = 0; ///< enclosed, in double, by the positions of the surface
    double isosurface_area = 0;
    double boundary_area = 0;
    std::uint64_t open_edges = 0; ///< edges at the boundary not used equally often in both directions; 0: closed
    std::uint64_t seam_edges =
        0; ///< where isosurfaces end inside the grid, at faces that lie back to back as their points
           ///< are doubled: the solid has walls there, and is no clean body
    std::uint64_t unfit_edges =
        0; ///< the same at faces that lie on smaller ones, which do not cover them, and at these
    std::vector<SolidPatch> patches; ///< of the grid, by number; those that are not on the solid have no triangles
    ContourResult contour;           ///< of the isosurfaces; its surfaces are empty
};

/// What Solid tells of its surface, of one that reduce() or keep_parts() changed.
///
/// `patches`   those that the cell field "patch" has, without their names; none where it was left out
struct SolidMeasure {
    std::uint64_t isosurface_triangles = 0;
    double volume = 0, isosurface_area = 0, boundary_area = 0;
    std::vector<SolidPatch> patches;
};

/// Cost     O(F)
/// Errors   invalid_argument: the surface has no cell field "boundary", or triangles that are not uint32; invalid_data: a
///          triangle has a vertex that is not there
ISOTET_API Result<SolidMeasure> measure_solid(const Surface& surface, const Run& run = {});

/// Makes solids of one grid and field, for one isovalue after another.
///
/// The isosurface is that of Contour. The boundary consists of the faces that cells with data do not share; polyhedra and
/// curved cells are taken as linear cells, curved ones refined for all isovalues. Faces on the side of the solid stay
/// whole, those that the isosurface crosses are cut where it crosses their edges, and share its vertices there. So both
/// together are closed: also at ties, beside cells without data, and where cells do not fit together, whose faces are
/// then boundary on both sides. Double sheets, where faces of cells are tied, are left out. A quadrilateral that is not flat gets a vertex inside each of its parts where it is
/// cut, so placed that the solids above and below an isovalue have the volume of the grid together.
///
/// Threads   one call at a time
class ISOTET_API Solids {
public:
    /// Finds the boundary, once for all isovalues.
    ///
    /// `options`   as of a session. Ties are merged; no frame (create_piece() takes one), exact vertices or gradient
    ///             normals. Vertex normals are of the isosurface and the boundary together
    /// Cost        a session, two passes over the cells and 8 bytes a point
    /// Errors      as Contour::create(), linearize(), refine() and boundary_of(); invalid_argument for other options
    static Result<Solids> create(ContourInput input, const ContourOptions& options = {}, const Run& run = {});

    /// The same of a piece of a grid: solids of all pieces are together those of the whole, closed and bit for bit. The faces
    /// at which the piece meets others are no boundary; so it comes with the cells of other pieces at them.
    ///
    /// Solid::volume and grid_volume() are shares of the whole's: their sums over all pieces. Open edges are not counted.
    ///
    /// `piece`     cells of the piece and, at least, those that share faces with them; as input of create()
    /// `ghosts`    one integer a cell: not 0 for those of other pieces, which give nothing
    /// `options`   with the frame of the whole
    /// Errors      as create(); invalid_argument without a frame, or with marks that do not fit
    static Result<Solids> create_piece(ContourInput piece, const Array& ghosts, const ContourOptions& options,
                                       const Run& run = {});

    Solids(Solids&&) noexcept;
    Solids& operator=(Solids&&) noexcept;
    ~Solids();

    /// The solid of a range of values.
    ///
    /// Guarantees   the same bytes for any thread count and on every engine; closed where Solid::open_edges is 0: always,
    ///              unless cells are repeated
    /// Cost         as Contour::extract(), and O(n) in the faces of the boundary; at ties O(n log n) in the triangles there,
    ///              and for pieces the isosurface of the ghost cells
    /// Errors       invalid_argument when no end of the range is finite, or lower >= upper; as Contour::extract()
    Result<Solid> extract(const SolidRange& range, const Run& run = {});

    /// The range of the field, as Contour::field().
    Result<FieldReport> field(const Run& run = {});

    /// The method of the isosurfaces, as Contour::method().
    Method method() const;

    /// The linear cells that were made of the grid; null where all its cells are linear.
    std::shared_ptr<const LinearGrid> linear_grid() const;

    /// Volume of all cells with data: enclosed by their boundary.
    double grid_volume() const;

private:
    struct Data;
    explicit Solids(std::unique_ptr<Data> data);
    static Result<Solids> make(ContourInput given, const Array* ghosts, const ContourOptions& options, const Run& run);
    std::unique_ptr<Data> data_;
};

// The part of a grid on one side of an isosurface, or between two of them, as a grid.

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
    std::uint64_t folded_pieces =
        0;                 ///< without polyhedra: pieces that no point sees from inside, some of whose cells are
                           ///< inside out
    ContourResult contour; ///< of the isosurfaces; its surfaces are empty
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
