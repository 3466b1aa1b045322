// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The part of a grid on one side of an isosurface, or between two of them, as a closed surface.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet {

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
    std::uint64_t seam_edges = 0; ///< where isosurfaces end inside the grid, at faces that lie back to back as their points
                                  ///< are doubled: the solid has walls there, and is no clean body
    std::uint64_t unfit_edges = 0; ///< the same at faces that lie on smaller ones, which do not cover them, and at these
    std::vector<SolidPatch> patches; ///< of the grid, by number; those that are not on the solid have no triangles
    ContourResult contour;        ///< of the isosurfaces; its surfaces are empty
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
ISOTET_API Result<SolidMeasure> measure_solid(const Surface& surface);

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

} // namespace isotet
