// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells that are not linear as cells that are: polyhedra as pyramids and tets around a derived point, quadratic cells as
// tets between their nodes. refine.hpp makes as many tets of quadratic cells as a tolerance needs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

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
};

/// True when some cells are polyhedra with faces, prisms of five or six sides, or of a degree above 1: linearize() makes
/// linear cells of them.
/// Cost   a parallel pass over the types
ISOTET_API bool has_cells_to_linearize(const Cells& cells);

/// True for VTK's numbers of three-dimensional cells of degree 2 and above, handled or not.
ISOTET_API bool is_curved(std::uint8_t vtk_type) noexcept;

/// True when some cells are curved. Cost   a parallel pass over the types
ISOTET_API bool has_curved_cells(const Cells& cells);

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
/// 10, and 78 to 80 (Bezier), are quadratic cells on their lattice first, with derived points. Others of degree 2 and above
/// are left out.
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

} // namespace isotet
