// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

// Cells that are not linear as cells that are: polyhedra as pyramids and tets around a derived point, quadratic cells as
// tets between their nodes. refine_curved() makes as many tets of quadratic cells as a tolerance needs.

/// Points made of the user's, D of them. Derived point d is the sum of weights[i] times point points[i] for
/// first[d] <= i < first[d + 1]; its weights have the sum 1.
///
/// `first`     uint64, D + 1, ascending from 0;  `points`  uint64, user's point numbers;  `weights`  float64, or empty: each is
///             1 over the number of points of its row
struct DerivedPoints {
    Array first;
    Array points;
    Array weights;

    std::uint64_t count() const noexcept { return first.empty() ? 0 : first.tuples() - 1; }
};

/// Points inside quadratic tets, R of them, and the quadratic tets, Q of them. The value at one is that of the quadratic field
/// through the ten nodes of its tet.
///
/// `places`    uint32, R x 3: weights of the tet's corners 0, 1 and 2, in steps of 2^-30
/// `parents`   uint32, R: the quadratic tet
/// `nodes`     uint32, Q x 10: corners by ascending number, then the middle of the edges 01, 02, 03, 12, 13, 23. A number of a
///             point before the refined ones; from there on a row of `hidden`; 2^32 - 1 is the mean of the edge's ends
/// `children`  uint32, Q: how many cells of the linear grid each tet became; cells stand in this order
/// `hidden`    nodes that are no points of the grid
struct RefinedPoints {
    Array places;
    Array parents;
    Array nodes;
    Array children;
    DerivedPoints hidden;

    std::uint64_t count() const noexcept { return places.tuples(); }
};

/// What became of quadratic cells.
struct RefinementReport {
    std::uint64_t curved_cells = 0;     ///< cells of degree 2 and above that were handled
    std::uint64_t unknown_cells = 0;    ///< Bezier pyramids, cells above degree 10: left out
    std::uint64_t left_out = 0;         ///< all cells that were left out, those of two dimensions too
    std::uint64_t quadratic_tets = 0;   ///< what all cells are split into
    std::uint64_t not_finite = 0;       ///< of these: dropped, for a node without a finite value
    std::uint64_t tets = 0, points = 0; ///< linear tets and points between nodes that were made
    bool refined = false;               ///< by refine(): else each edge with a node was bisected once
    double tolerance = 0;               ///< of the field, in its unit, as asked for
    bool carried_left_out = false;      ///< memory does not suffice to follow RefineOptions::carried
    double field_bound = 0;             ///< proven: the field's error is nowhere larger in the tets that were made
    double geometry_bound = 0;          ///< proven: the tets are nowhere farther from the curved cells
    bool too_fine = false;              ///< an edge could not be bisected any further: bounds may exceed tolerances
    std::vector<double> isovalues;      ///< the only ones that the grid is good for, ascending; empty: all
    bool too_bent = false;       ///< an edge bends strongly at every length, as where a cell folds: it was bisected
                                 ///< to 1/64 of a cell only, and geometry_bound may be large
    double wanted_distance = 0;  ///< RefineOptions::distance
    double distance = 0;         ///< with it: 99 of 100 tets have a surface not farther from that of the
                                 ///< quadratic field, by estimate: the tet's bound over its gradient
    double largest_distance = 0; ///< the largest of all tets; infinite where the field is flat
};

/// What linearize() did, in cells of the user's grid.
struct LinearizeReport {
    std::uint64_t polyhedra = 0;    ///< cells that are polyhedra, with their faces, or prisms of five or six sides
    std::uint64_t known_shapes = 0; ///< of these: tetrahedra, pyramids, wedges and hexahedra, which stay whole
    std::uint64_t centred = 0;      ///< of these: split around a derived point
    std::uint64_t moved_centres =
        0;                    ///< of these: that point is not the mean of the corners, but moved to see all faces
    std::uint64_t folded = 0; ///< centred ones where no point was found that sees all faces
    std::uint64_t open = 0;   ///< polyhedra left out: some edge is not in two faces, or the faces are not one shell
    std::uint64_t cells = 0;  ///< linear cells that polyhedra became
    std::uint64_t unmet = 0; ///< polyhedra that LinearizeOptions::isovalues left out; the other counts are without them
    std::uint64_t high_degree = 0;       ///< Lagrange cells of degree 3 and above, and Bezier cells, that were split
    std::uint64_t high_degree_parts = 0; ///< cells of degree 2 that these became

    /// Sentences for the user, what was split and what was left out.
    ISOTET_API std::vector<std::string> notes() const;
};

/// A grid of linear cells, and what connects it with the grid that it was made of. A handle on arrays: copying shares them.
struct ISOTET_API LinearGrid {
    Grid grid; ///< the user's points, then the derived ones; linear cells; no fields
    std::uint64_t user_points =
        0; ///< grid.points from this number on are derived: row 0, 1, ... of `derived`, then 0, 1,
           ///< ... of `refined`
    std::uint64_t user_cells = 0;
    DerivedPoints derived;
    Array source_cells; ///< uint64, the user's cell of each cell of `grid`, ascending; empty: they are the same
    LinearizeReport report;
    RefinedPoints refined;       ///< of quadratic cells; none where there are none
    RefinementReport refinement; ///< likewise
    Array derived_numbers = {};  ///< uint64, of derived points: theirs with all polyhedra, where these were asked for

    /// An array of one tuple a user's point, continued for the derived points: computed in double, rounded once.
    /// float32 and float64 keep their type; integers become float64. NaN at a derived point where one of its points has NaN.
    ///
    /// Guarantees   linear fields stay linear, constant ones constant; at a point inside a polyhedron no value is outside
    ///              those of its corners; the same bytes for any thread count
    /// Cost         one pass; a copy of the array, and the derived tuples
    /// Errors       invalid_argument when it has not one tuple a user's point; out_of_memory; cancelled
    Result<Array> extend(const Array& values, const Run& run = {}) const;

    /// The same of one scalar a point, but a point around which a polyhedron was split has its cell's value of `cell_values`,
    /// one scalar a user's cell, which may lie outside those of the corners.
    /// Errors   invalid_argument also where there are points inside other cells (report.high_degree, refined)
    Result<Array> extend(const Array& values, const Array& cell_values, const Run& run = {}) const;

    /// An array of one tuple a user's cell, for the cells of `grid`, in its own type.
    /// Errors   invalid_argument when it has not one tuple a user's cell; out_of_memory; cancelled
    Result<Array> of_cells(const Array& values, const Run& run = {}) const;
};

struct LinearizeOptions {
    bool known_shapes = true; ///< false: every polyhedron is split around a derived point
    /// Not empty: polyhedra that none of these meets are left out, which have no part of these isosurfaces of `values`, one
    /// scalar a point. Not for grids with curved cells or point numbers.
    std::vector<double> isovalues = {};
    Array values = {};
    std::vector<std::uint64_t> also = {}; ///< user's cells that stay though no isovalue meets them, ascending
    bool numbers = false;                 ///< LinearGrid::derived_numbers, for which all are split, but not kept
    bool around = false; ///< polyhedra that share a point with a cell that is met stay, too: for gradients
};

/// Six times the volumes of the user's cells, by which cell fields are averaged to points; -1 for cells that are left out.
///
/// Linear cells and polyhedra of known shapes: the sum over their tets, each taken as positive; other polyhedra: what their faces
/// enclose, each a fan from its lowest point; curved cells: the sum over the linear cells that linearize() makes of them.
///
/// Cost     of polyhedra about a quarter of linearize(), 8 bytes a cell; where there are curved cells or point numbers, linearize()
/// Errors   as linearize()
ISOTET_API Result<std::vector<double>> relative_volumes(const Grid& grid, const Run& run = {});

/// Makes every cell linear that can be. Linear cells stay as they are, in their order; each polyhedron is replaced by what
/// it becomes. Pentagonal and hexagonal prisms (VTK's 15 and 16) are polyhedra of known faces.
///
///   a known shape   a tetrahedron, pyramid, wedge or hexahedron given by its faces is that cell
///   any other       pyramids on its quadrilaterals and tets on its triangles, around a derived point: the mean of its
///                   corners, moved where it does not see all faces. Larger faces are cut into triangles, from the lowest
///                   point number, or by ears where that would be thin or fold: by the face alone, so neighbours agree
///                   no point sees all faces: types 210 (tetrahedron) and 214 (pyramid), which are stored in the order of
///                   their corners, inside out or not
///   open            left out: type 0 (empty), without corners
///
/// Where some cells are quadratic, all cells become tets, each edge with a node bisected once, and cells that cannot be
/// contoured are gone: VTK's types 24 to 27, 29, 31 to 33, 37, and 71 to 74 of order 1 and 2. Those of 71 to 74 up to degree
/// 10, and 78 to 80 (Bezier), are quadratic cells on their lattice first, with derived points, which polyhedra beside them
/// take on common edges and faces. Others of degree 2 and above are left out.
///
/// Faces may be wound in any way and stand in any order: the result is the same.
///
/// `grid`       its fields are not looked at
/// Guarantees   a conforming grid stays conforming; the same bytes for any thread count
/// Cost         O(n); 20 to 30 bytes a linear cell and 8 + 16 bytes a corner of a centred polyhedron
/// Errors       invalid_data as survey(), for faces that are not there or have points out of range, and for numbers of nodes
///              that do not fit the type; out_of_memory; cancelled
/// Threads      safe from many threads on one grid
/// Method       docs/cells.md
ISOTET_API Result<LinearGrid> linearize(const Grid& grid, const LinearizeOptions& options = {}, const Run& run = {});

// Quadratic cells as linear tets, as many as a tolerance needs, with a proven bound.

struct RefineOptions {
    /// Largest error of the field, in its unit; 0: `relative_tolerance` times its range, if that is above 0.
    double tolerance = 0;
    double relative_tolerance = 1e-3;
    /// Largest distance of the tets from the curved cells, in the points' unit; 0: edges leave the curve by at most a
    /// hundredth of their length.
    double geometry_tolerance = 0;
    /// Only what these can meet is kept: the grid is good for them alone. Where they meet nothing, some tets stay, so that the
    /// grid can be contoured. Empty: all is kept.
    std::vector<double> isovalues = {};
    /// More tets than this are an error; 0: as many as free memory holds.
    std::uint64_t max_tets = 0;
    /// Largest distance of the surface from that of the quadratic field, in the points' unit, by estimate: an edge may
    /// deviate by this times the least gradient of the field at its ends, but always by 10^-5 of the range. 0: not looked
    /// at. What of tolerance, relative_tolerance and distance is above 0 holds together.
    double distance = 0;
    /// Other fields of the points, any components: cells are bisected for them, too, where a component is off by more than
    /// `carried_tolerance` of its range, but for them no edge to less than a quarter of a cell's. For cuts, whose own field is
    /// made of the places: fields that they carry follow the cells' functions, too. Of floating numbers: others are passed
    /// over, and so are cells at whose nodes a component is not finite. Where memory does not suffice for them, none is
    /// followed (RefinementReport::carried_left_out).
    std::vector<Field> carried = {};
    double carried_tolerance = 0.01; ///< 0: they are not followed
};

/// Makes linear tets of all cells that linearize() handles, so fine that the field, linear in each tet, differs from the
/// cell's own by the tolerance at most, as far as cells may be bisected for it.
///
/// A cell is split into quadratic tets, by the rule of split(), and these are bisected until they are near the cell's own
/// functions, with the cell's values at new points. Then they are bisected into linear tets at the edge that deviates
/// most, in
/// steps of 4 times, of several at the longest, ties by point numbers: this depends on edges alone, so neighbours agree.
///
/// `grid`       its fields are not looked at
/// `field`      one scalar a point; quadratic tets with a node that is not finite are dropped
/// Guarantees   conforming; the field's error is at most LinearGrid::refinement.field_bound, for the tets that are kept; the
///              same bytes for any thread count; with isovalues the same surfaces of these as without, to the triangle
/// Cost         in proportion to the tets that it makes; 24 bytes a tet and 12 a point, and twice that for a while
/// Errors       as linearize(); invalid_argument for a tolerance that is negative or not finite, or fields that do not fit;
///              out_of_memory, before memory runs out, where the tolerance asks for too many tets; cancelled
/// Threads      safe from many threads on one grid
/// Method       docs/cells.md
ISOTET_API Result<LinearGrid> refine(const Grid& grid, const PointField& field, const RefineOptions& options = {},
                                     const Run& run = {});

/// How far another field, linear in each tet of a grid of linearize() or refine(), is at most from the quadratic interpolants.
///
/// `values`     one scalar a user's point
/// Cost         a pass over the tets
/// Errors       invalid_argument when the values do not fit; out_of_memory; cancelled
ISOTET_API Result<double> field_bound(const LinearGrid& linear, const Array& values, const Run& run = {});

// Hanging points: points on faces and edges of larger cells, which do not have them, as where adaptive solvers refine
// some cells and not their neighbours. The surface is open there, unless the larger cells list these points.

/// Places in a face or edge of a larger cell that does not have them, as between levels of refinement: the surface is open
/// there. Points of the same place count once.
///
/// Guarantees   the same for any thread count; 0 where more than 4 million faces, and more than there are tets, are boundary
/// Cost         as survey() with faces; a sort of the boundary's faces
/// Errors       as survey()
ISOTET_API Result<std::uint64_t> count_hanging_points(const Grid& grid, const Run& run = {});

/// What was found.
struct HangingReport {
    std::uint64_t points = 0;     ///< that hang on a face or an edge of a larger cell
    std::uint64_t faces = 0;      ///< of larger cells, which smaller faces of other cells cover
    std::uint64_t near_faces = 0; ///< of these: some points are beside the face, as on curved shapes
    double largest_distance = 0;  ///< of these from the face, in the unit of the points
    std::uint64_t levels = 0;     ///< n: an edge meets up to 2^n smaller ones
    std::uint64_t cells = 0;      ///< that list hanging points now
    std::uint64_t open_faces = 0; ///< on smaller ones that do not cover them: the surface stays open there
    /// Of the cells that list hanging points: those above degree 1. As polyhedra they are linear between their points, and
    /// the bounds of refine() are not against their own functions.
    std::uint64_t curved_cells = 0;

    /// Sentences for the user.
    ISOTET_API std::vector<std::string> notes() const;
};

/// A grid whose cells list the points on their faces.
struct ISOTET_API ClosedGrid {
    Grid grid; ///< the same points, cells in the same order, and fields
    HangingReport report;
    Array points;          ///< uint64, H: those that hang; of one that hangs between others, these come before
    DerivedPoints parents; ///< H rows: the larger cell's own value there, as weights of the corners of its face or edge

    /// A point field that has the larger cells' values at hanging points. float32 and float64 keep their type; integers
    /// become float64.
    ///
    /// Cost     a copy, and the hanging points
    /// Errors   invalid_argument when it has not one tuple a point; out_of_memory; cancelled
    Result<Array> interpolated(const Array& values, const Run& run = {}) const;

    /// The largest difference between these and the field's own values, of all components; NaN aside.
    /// Errors   as interpolated()
    Result<double> largest_difference(const Array& values, const Run& run = {}) const;
};

/// Finds hanging points by their places, and gives the cells that have them on a face or an edge as polyhedra that list
/// them: a face that smaller ones cover becomes these, and an edge becomes as many. linearize() splits them as any
/// others, by rules that depend on each face alone, so the surface is closed. All other cells stay as they are; so does
/// a grid without hanging points, whose arrays are shared.
///
/// A face is covered by faces of other cells that share points with it, face the other way, lie on it, and together
/// have its outline, whatever their number and sizes; faces of one size that only differ in their diagonals do not
/// count. Faces may be warped, cells of any kinds, and several levels meet in one face. Points that coincide must be
/// one (merge_points()).
///
/// Cells above degree 1 that list hanging points become polyhedra of their corners and of their nodes on edges that no
/// other such cell has (of Bezier cells of corners alone); points that hang on these have no parents.
///
/// Guarantees   the same bytes for any thread count; a face that has a neighbour of its own is never looked at, but for
///              hashes that are equal by chance: 2^-64 a face
/// Cost         two passes over the cells, 8 bytes a point; sorting of the faces without a neighbour, about 200 bytes
///              each; where points hang, another pass and new cells
/// Errors       invalid_data as survey(); out_of_memory; cancelled
/// Threads      safe from many threads on one grid
/// Method       docs/inside/hanging.md
ISOTET_API Result<ClosedGrid> close_hanging_points(const Grid& grid, const Run& run = {});

/// Closes grids, and gives the last cells again for a grid with the same cells and points, as time steps mostly have.
///
/// Threads   safe from many: one call waits for another
class ISOTET_API KnownClosing {
public:
    KnownClosing();
    ~KnownClosing();

    /// close_hanging_points(grid). Where cells and points are those of the last call, in the same memory or by a fingerprint of
    /// 128 bits, the cells, if some list points, are in the memory that that call gave.
    ///
    /// Cost   a pass over cells and points, and close_hanging_points() where they are others
    Result<ClosedGrid> of(const Grid& grid, const Run& run = {});

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace isotet
