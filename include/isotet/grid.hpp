// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// What the tuples of a field belong to.
enum class Association : std::uint8_t { point, cell };

/// Cell types, with VTK's numbers and VTK's order of corners. Any other number is a cell that isotet leaves out.
enum class CellType : std::uint8_t { tetrahedron = 10, voxel = 11, hexahedron = 12, wedge = 13, pyramid = 14 };

/// "tetrahedron", "quadratic tetrahedron", "polygon" and so on for any of VTK's numbers; "cell type 97" otherwise.
ISOTET_API std::string name_of_cell_type(std::uint8_t vtk_type);

/// Scalars that lie `stride` bytes apart: a member of structs, or an array of its own (stride: the scalar's size).
struct StridedScalars {
    ScalarType type = ScalarType::float32;
    const void* first = nullptr;
    std::ptrdiff_t stride = 0; ///< of any size and sign; 0: one scalar for all rows

    template <class T>
    static StridedScalars of(const T* first, std::ptrdiff_t stride = sizeof(T)) {
        return {scalar_type_of<T>(), first, stride};
    }
};

/// An array of what does not lie one behind another: points of structs, or x, y and z apart. Its memory is its own.
///
/// `columns`   one a component, of one type
/// Cost        a copy, by all threads
/// Errors      invalid_argument: no columns, of several types, null; out_of_memory
ISOTET_API Result<Array> interleave(std::span<const StridedScalars> columns, std::size_t rows, const Run& run = {});

/// The cells of a grid: corners of all cells one after another, and where each cell's corners start.
///
/// `connectivity`  int32, uint32, int64 or uint64, one component; the point numbers of the corners
/// `offsets`       int32, uint32, int64 or uint64, one component, one more than there are cells; or empty: then every
///                 cell is a `uniform_type` and cell c starts at c times its number of corners
/// `types`         uint8, one a cell (VTK's numbers); or empty: every cell is a `uniform_type`
/// `faces`         empty, or as the connectivity: the faces of polyhedra (VTK's 42). A cell has its number of faces, then
///                 for each face its number of points and these points, in any winding
/// `face_offsets`  empty, or as the offsets, one more than there are cells: where each cell's part of `faces` starts; cells
///                 of other types have none. A polyhedron's own points stand in the connectivity, each once. The faces
///                 of pentagonal and hexagonal prisms (15, 16) follow from their type
struct ISOTET_API Cells {
    Array connectivity;
    Array offsets;
    Array types;
    CellType uniform_type = CellType::tetrahedron;
    Array faces = {};
    Array face_offsets = {};

    std::size_t count() const noexcept;
};

/// What a number of BoundaryPatches stands for.
struct PatchName {
    std::int64_t number = 0;
    std::string name;
};

/// Parts of the boundary that a file names (patches, side sets, boundary conditions), as faces with a number each. A face of
/// a cell is of the first patch that has all its points.
///
/// `points`   int64, the points of all faces one after another, in any order; those of a set of points are one face
/// `offsets`  int64, one more than there are faces, ascending from 0
/// `numbers`  int64, one a face: not negative
struct BoundaryPatches {
    Array points;
    Array offsets;
    Array numbers;
    std::vector<PatchName> names = {};

    std::size_t count() const noexcept { return numbers.tuples(); }
};

/// Points, cells and fields, as the user has them: any order, any numeric type. Arrays are shared, never copied.
///
/// `points`        float32 or float64, 3 components
/// `point_fields`  one tuple a point;  `cell_fields`  one tuple a cell. Names may occur in both.
/// `point_numbers` empty, or one 32- or 64-bit integer a point, all different: where the order of point numbers decides
///                 (how cells are split, how quadrilaterals of a tet are cut), these count instead of the indices. For
///                 pieces of a grid: the numbers in the whole grid (pieces.hpp). Costs a copy of cells and points while
///                 packing or extracting directly
/// `patches`       empty, or the parts of the boundary that the file names: solids tell which triangle is of which
struct Grid {
    Array points;
    Cells cells;
    std::vector<Field> point_fields;
    std::vector<Field> cell_fields;
    Array point_numbers = {};
    BoundaryPatches patches = {};
};

/// What a grid holds and what is odd about it. Nothing here is an error: errors are returned by survey() itself.
struct GridReport {
    std::size_t points = 0;
    std::size_t cells = 0;
    std::map<std::uint8_t, std::size_t> cells_by_type; ///< VTK's number -> cells
    std::size_t cells_left_out = 0;                    ///< cells of types that are not contoured (2D, quadratic), and
                                                       ///< polyhedra without faces that close
    std::size_t tets = 0;                              ///< after splitting, collapsed ones dropped, repeated ones
                                                       ///< counted
    std::size_t collapsed_tets = 0;         ///< tets with a repeated corner, dropped (of a collapsed hexahedron, say)
    std::size_t negative_tets = 0;          ///< tets of negative volume in the order of the file, repeated ones counted
    std::size_t inverted_tets = 0;          ///< tets whose sign is not that of most, repeated ones counted
    std::size_t flat_tets = 0;              ///< tets of volume exactly zero, repeated ones counted
    std::size_t unused_points = 0;          ///< points that no tet uses
    std::array<double, 3> lower{}, upper{}; ///< bounds of the used points; without tets of all that are finite

    // Counted only with SurveyOptions::faces, and where there are tets.
    std::size_t repeated_tets = 0;    ///< tets with the same four corners as an earlier one; packing keeps the first
    std::size_t duplicate_points = 0; ///< used points with the coordinates of a used point of a lower number
    std::size_t boundary_faces = 0;   ///< faces that one cell has: tets, those of a twisted cell turned as the cell,
                                      ///< do not use them equally often in both directions, repeated ones aside
    std::size_t quads_on_triangles =
        0; ///< quadrilateral faces that meet triangular ones of other cells: where cells are
           ///< not split, the surface may be open there
};

struct SurveyOptions {
    bool faces = true; ///< count repeated tets, duplicate points and boundary faces, too
};

/// Checks a grid and counts what is in it. Polyhedra are counted as tets of what linearize() makes of them.
///
/// Guarantees   the same counts for any thread count; a point's boundary faces are missed with probability 2^-64, as by
///              boundary_of() (boundary.hpp)
/// Cost         O(n): two passes over the cells and one over the points, a byte a point; with `faces` every tet, face
///              and point is hashed, too: 17 bytes a point, and up to 32 bytes a tet beside the boundary, or a quarter
///              of the free memory where that is less (then in several passes over the cells)
/// Errors       invalid_data: point number out of range, array of the wrong length or type, wrong number of corners,
///              offsets that fall, a coordinate that is not finite or is 2^91 or more where a cell uses the point;
///              out_of_memory; cancelled
/// Threads      safe from many threads on one grid
ISOTET_API Result<GridReport> survey(const Grid& grid, const SurveyOptions& options = {}, const Run& run = {});

/// Tets, and where they come from.
struct TetList {
    std::vector<std::array<std::uint64_t, 4>> tets; ///< point numbers
    std::vector<std::uint64_t> cells;               ///< the cell each tet comes from
};

/// The tets that isotet makes of a grid, in the user's order: each cell's tets one after another, collapsed ones
/// dropped, corners in the order of the file (tetrahedra) or of the splitting; orientation is not changed.
///
/// Hexahedra, voxels, wedges and pyramids are split by the rule of the lowest point number (Grid::point_numbers, or else
/// the index) on each quadrilateral face
/// (Dompierre, Labbé, Vallet, Camarero 1999), so that neighbours always agree, whatever their types.
///
/// Guarantees   the same tets for any thread count
/// Errors       as survey()
ISOTET_API Result<TetList> split(const Grid& grid, const Run& run = {});

/// What point fields have at merged points.
enum class MergedValues : std::uint8_t {
    lowest, ///< the value of the lowest-numbered of them
    mean,   ///< the mean of all that are not NaN, for fields that jump between cells
};

struct MergeOptions {
    double tolerance = 0; ///< points at most this far apart are merged; 0: exactly equal coordinates (-0 equals +0)
    MergedValues values = MergedValues::lowest;
};

/// The largest difference of a point field's values at points that were merged, of any component.
struct FieldJump {
    std::string field;
    double largest = 0;
};

/// A grid after welding.
struct MergedPoints {
    Grid grid;
    std::size_t merged = 0;          ///< points no longer used
    std::size_t collapsed_cells = 0; ///< cells of which two corners became the same point
    std::vector<FieldJump> jumps;    ///< one a point field
};

/// Welds points: every cell, also curved ones and polyhedra, then uses the lowest-numbered point of each chain of close
/// points. Points and point fields keep their numbers and lengths.
///
/// Means are computed in double in the order of point numbers, and rounded once; fields of integers become float64.
///
/// Guarantees   the same for any thread count
/// Errors       invalid_argument when the tolerance is negative or not finite, or so large that every contoured cell
///              collapses; invalid_data as survey(), or for a field whose length is not that of the points; out_of_memory
/// Cost         O(P log P), 24 bytes a point, and a new connectivity; a pass over each point field, which means copy
ISOTET_API Result<MergedPoints> merge_points(const Grid& grid, const MergeOptions& options = {}, const Run& run = {});

/// Two ends of a range; lower > upper: there is no value.
struct ValueRange {
    double lower = 1, upper = 0;
};

/// Numbers that stand for no value, as files have them in place of NaN: -9999, 1e20, 9.96921e36.
struct FillValues {
    struct Number {
        double value = 0;
        std::uint64_t count = 0; ///< of the values that are it
    };
    std::vector<Number> numbers; ///< ascending; empty: there is none
    ValueRange others;           ///< of all other finite values
    std::uint64_t values = 0;    ///< all that were looked at
};

/// A field to contour: one scalar per point of the grid, and how it was found.
struct PointField {
    std::string name;       ///< as asked for, such as "velocity:x"
    Array values;           ///< one component, one scalar a point
    bool averaged = false;  ///< made from a cell field by volume-weighted averaging
    std::string note;       ///< empty, or a sentence for the user (a name that is both a point and a cell field, say)
    Array cell_values = {}; ///< empty, or one scalar a cell: a session gives them to the derived points around which
                            ///< polyhedra are split, in place of means of the points around
    FillValues cell_fill = {}; ///< where averaged: of the cell values, which count in the means
};

/// True when some cells are polyhedra with faces, prisms of five or six sides, or of a degree above 1: linearize() makes
/// linear cells of them.
/// Cost   a parallel pass over the types
ISOTET_API bool has_cells_to_linearize(const Cells& cells);

/// True for VTK's numbers of three-dimensional cells of degree 2 and above, handled or not.
ISOTET_API bool is_curved(std::uint8_t vtk_type) noexcept;

/// True when some cells are curved. Cost   a parallel pass over the types
ISOTET_API bool has_curved_cells(const Cells& cells);

// Cheap looks at a grid that has been read: what survey() counts exactly, and more, takes longer. After a cancel, what they
// return means nothing.

/// Cells by type (CellType, or VTK's number of a type that is not contoured), contoured or not.
///
/// Guarantees   the same for any thread count; an empty map when Cells::types is no array of uint8
/// Cost         one parallel pass over the types; none where all cells have the same type
ISOTET_API std::map<std::uint8_t, std::uint64_t> count_cells_by_type(const Cells& cells, const Run& run = {});

/// True for the types of which isotet makes tets: tetrahedron, voxel, hexahedron, wedge and pyramid.
ISOTET_API bool is_contoured(std::uint8_t cell_type) noexcept;

/// Whether there are triangles, polygons or quadrilaterals, and no cells with a volume: a shell, a surface, a result in two
/// dimensions. It has no isosurface; its cells are what boundary_of() gives. Cost: one pass over the types
ISOTET_API bool has_only_flat_cells(const Cells& cells);

/// Points that have the coordinates of another point, but for roundings. Topology goes by point numbers, so surfaces are
/// open there, until merge_points() joins them.
struct CoincidentPoints {
    std::uint64_t points = 0; ///< but the first at each place
    bool estimated = false;   ///< from a sample: exact up to 65,536 points
};

/// Estimates how many points that cells use coincide with others. The grid need not have been checked.
///
/// Places are one within rounding_of(), or 6e-8 of the largest coordinate where cells share next to no points.
///
/// Guarantees   the same for any thread count; 0 where fewer than a thousandth of the points coincide
/// Cost         one parallel pass over the points, about 65,000 of which are looked up; two over the connectivity only
///              where points coincide
ISOTET_API CoincidentPoints estimate_coincident_points(const Grid& grid, const Run& run = {});

/// A power of ten within which points lie that a program has computed twice: they may differ by roundings of the grid's size.
/// 0 where no coordinate but 0 is finite. Cost: one pass over the points
ISOTET_API double rounding_of(const Array& points, const Run& run = {});

/// False where estimate_coincident_points() finds none within rounding_of(), whatever the cells are. Cost: its first pass
ISOTET_API bool may_have_coincident_points(const Array& points, const Run& run = {});

} // namespace isotet
