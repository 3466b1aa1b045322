// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
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

/// What normals a surface has.
enum class Normals : std::uint8_t {
    none,
    gradient, ///< one a vertex, of the field; on thin cells they may turn away from the surface
    face,     ///< one a triangle
    vertex    ///< one a vertex, vertex_normals(): they follow the surface
};

inline bool are_of_vertices(Normals normals) { return normals == Normals::gradient || normals == Normals::vertex; }

/// Triangles on welded vertices. V vertices, F triangles.
///
/// `positions`     3 components, V tuples, in the coordinates of the grid: float32 where its points are float32 and the
///                 precision is single, else float64
/// `triangles`     uint32 (uint64 from 2^32 vertices on), 3 components, F tuples; counter-clockwise seen from the side
///                 of higher values
/// `normals`       empty, or float32, 3 components: V tuples (gradient, vertex) or F tuples (face); unit length, or zero where
///                 nothing defines one; towards higher values
/// `edge_ends`     empty, or int64, 2 components, V tuples: the user's numbers of the points between which the vertex
///                 lies, the one below first; both the same for a vertex at a tied point
/// `edge_weights`  empty, or float32 (float64), V tuples: 0 at the first end, 1 at the second
/// `source_cells`  empty, or int64, F tuples: the user's cell of each triangle
struct Surface {
    Array positions;
    Array triangles;
    Normals normals_kind = Normals::none;
    Array normals;
    Array edge_ends;
    Array edge_weights;
    Array source_cells;
    std::vector<Field> point_fields; ///< V tuples each: float32 where the grid's field is float32 and the precision is
                                     ///< single, else float64
    std::vector<Field> cell_fields;  ///< F tuples each, in the grid's own type

    std::size_t vertex_count() const noexcept { return positions.tuples(); }
    std::size_t triangle_count() const noexcept { return triangles.tuples(); }
};

/// Joins surfaces into one, vertices and triangles one after another; fields that not all of them have are dropped,
/// empty surfaces aside. Arrays of different types become float64.
/// With `isovalues` (one a surface) the result has a cell field "isovalue", float64.
ISOTET_API Surface join(const std::vector<Surface>& surfaces, const std::vector<double>& isovalues);

/// A normal for each vertex: the mean of its faces' normals, weighted by their areas. It agrees with the triangles also where
/// cells are thin, and gradients of the field do not.
///
/// Returns      float32, 3 components, V tuples; unit length, or zero where a vertex has no face with an area
/// Guarantees   the same for any thread count
/// Cost         O(V + F); 12 bytes a triangle and 8 a vertex while it works
/// Errors       invalid_data when a triangle has a vertex that is not there; out_of_memory
ISOTET_API Result<Array> vertex_normals(const Surface& surface, const Run& run = {});

/// A normal for each triangle, as Normals::face.
///
/// Returns      float32, 3 components, F tuples; unit length, or zero where a triangle has no area
/// Guarantees   the same for any thread count
/// Cost         O(F)
/// Errors       invalid_data when a triangle has a vertex that is not there; out_of_memory
ISOTET_API Result<Array> face_normals(const Surface& surface, const Run& run = {});

/// Writes positions for a renderer: float32, relative to an origin near them, so that places far from zero stay apart.
///
/// `out`      of the caller, 3 a vertex; written once, never read: mapped memory of a device
/// Cost       a pass over the positions
/// Errors     invalid_argument: `out` has another size, the origin is not finite; invalid_data: positions are no floats
ISOTET_API Result<void> write_positions(const Surface& surface, const std::array<double, 3>& origin,
                                        std::span<float> out, const Run& run = {});

/// Area of all triangles, summed in double in a fixed order; NaN when check() would call the surface invalid, or after a cancel.
ISOTET_API double area(const Surface& surface, const Run& run = {});

// The connected parts of a surface: counted, measured, kept or left out.

/// Triangles that hang together by their vertices.
struct SurfacePart {
    std::uint64_t triangles = 0, vertices = 0;
    double area = 0;
    double volume = 0;   ///< enclosed, positive where triangles face outwards; means something where it is closed
    bool closed = false; ///< every edge is used equally often in both directions
    std::array<double, 3> centre{}; ///< of its area
    std::array<double, 3> lower{}, upper{};
    std::vector<double> means; ///< of SurfaceParts::fields, weighted by area
};

/// `parts`     largest area first; of equal ones the one with the lowest vertex
/// `numbers`   uint32, F tuples: the part of each triangle, from 0
/// `fields`    names of the point and cell fields of the surface, a component each: "p", "velocity:0" and so on
struct SurfaceParts {
    std::vector<SurfacePart> parts;
    Array numbers;
    std::vector<std::string> fields;
};

/// Finds the parts of a surface and measures them.
///
/// Guarantees   the same for any thread count
/// Cost         O(F log F); 60 bytes a triangle while it works
/// Errors       invalid_data as check(), and from 2^32 parts on; out_of_memory; cancelled
ISOTET_API Result<SurfaceParts> find_parts(const Surface& surface, const Run& run = {});

/// The surface with some of its parts only, and the cell field "part" with their numbers.
///
/// `kept`     numbers of parts; all: only the field is added
/// Guarantees vertices and triangles keep their order; vertices that no triangle uses are gone
/// Errors     invalid_argument when a number is not below that of the parts, or the parts are of another surface
ISOTET_API Result<Surface> keep_parts(const Surface& surface, const SurfaceParts& parts,
                                      const std::vector<std::uint64_t>& kept, const Run& run = {});

/// A region by what its cells have: a value of a cell field in [lower, upper], of any component.
struct Region {
    std::string field; ///< a cell field that the surface carries; "boundary" of a solid is 1 on the grid's boundary
    double lower = 0, upper = 0;
};

/// Numbers of the parts that touch a region, ascending: those with a triangle in one of its cells.
///
/// Errors   invalid_argument when the surface has no such cell field, the range does not ascend, or the parts are of
///          another surface
ISOTET_API Result<std::vector<std::uint64_t>> parts_touching(const Surface& surface, const SurfaceParts& parts,
                                                             const Region& region);

/// Which connected parts of a surface are kept.
struct PartChoice {
    enum class Kind : std::uint8_t {
        largest,  ///< the `limit` ones of largest area
        area,     ///< those of a larger area than `limit`
        volume,   ///< closed ones that enclose more than `limit`
        touching, ///< those that touch `region` (parts_touching())
        numbers,  ///< those of `numbers`
        others    ///< all but those of `numbers`
    };
    Kind kind = Kind::largest;
    double limit = 1;
    std::string region = {};                 ///< "boundary", the grid's, or what else a caller knows
    std::vector<std::uint64_t> numbers = {}; ///< as SurfaceParts counts; those that are not there do not matter

    friend bool operator==(const PartChoice&, const PartChoice&) = default;
};

/// "largest", "3", "area>0.5", "volume>2", "touching:boundary", "parts:0,2" or "not:1", and back. Nothing where it is none
/// of these.
ISOTET_API std::optional<PartChoice> parse_part_choice(std::string_view text);
ISOTET_API std::string to_text(const PartChoice& choice);

/// What parts are of: so it is known which of them touch the boundary of the grid.
enum class PartsOf : std::uint8_t {
    isosurface, ///< those that are not closed
    solid       ///< those with a triangle where the cell field "boundary" is 1
};

/// The numbers of the parts of a choice, ascending.
///
/// Errors   invalid_argument where a region other than "boundary" is to be touched, which parts_touching() finds; as that
ISOTET_API Result<std::vector<std::uint64_t>> chosen_parts(const Surface& surface, const SurfaceParts& parts,
                                                           const PartChoice& choice, PartsOf of);

/// Finds the parts of a surface, and keeps those of a choice. No field is added.
///
/// Errors   as find_parts(), chosen_parts() and keep_parts()
ISOTET_API Result<Surface> keep_parts(const Surface& surface, const PartChoice& choice, PartsOf of,
                                      const Run& run = {});

// Surfaces with fewer triangles.

/// Both limits hold: triangles go until one of them is reached.
///
/// `share`   of the triangles that may go, from 0 to below 1; of a piece four stay, if it has so many
/// `error`   how far the surface may move, in units of the grid, by meshoptimizer's measure: a mean, no bound
struct ReduceOptions {
    double share = 0.9;
    double error = std::numeric_limits<double>::infinity();
};

struct ReducedSurface {
    Surface surface;
    std::uint64_t triangles_before = 0;
    double error = 0;                  ///< that was reached, by the same measure
    std::vector<std::string> left_out; ///< names of what a reduced surface has no place for
};

/// Leaves out vertices and joins the triangles around them, where that moves the surface least.
///
/// Vertices that stay are those of `surface`, with their fields. Triangles that differ in the cell field isovalue, part
/// or boundary are reduced by themselves, all to one error, and vertices at borders of these and of the surface stay:
/// what was closed is closed. Other cell fields, edge_ends and source_cells are left out; normals of triangles and of Normals::vertex are
/// worked out anew.
///
/// Guarantees   the same for any thread count; other versions of meshoptimizer may choose other vertices
/// Cost         O(F log F) on one thread, about a second a million triangles, up to nine where there are such
///              parts; 150 bytes a triangle while it works
/// Errors       invalid_argument: a share outside 0 to 1, an error below 0, from 2^32 vertices on; invalid_data as
///              check(); out_of_memory; cancelled
/// Method       meshoptimizer, which cannot be asked to stop: large parts in a forked process
ISOTET_API Result<ReducedSurface> reduce(const Surface& surface, const ReduceOptions& options = {},
                                         const Run& run = {});

/// The arrays of a Surface (surface.hpp).
enum class SurfaceArray : std::uint8_t {
    positions,
    triangles,
    normals,
    edge_ends,
    edge_weights,
    source_cells,
    point_field,
    cell_field
};

/// Gives the memory in which surfaces are made: a shared segment, a mapped file, memory that a device sees.
///
///     struct Segment : SurfaceSink {
///         std::shared_ptr<void> take(const Wanted& wanted) override { return reserve(wanted.bytes()); }
///     };
///     options.sink = std::make_shared<Segment>();
class ISOTET_API SurfaceSink {
public:
    struct Wanted {
        std::size_t surface = 0; ///< which of the call's isovalues
        SurfaceArray array = SurfaceArray::positions;
        std::string_view field; ///< its name; empty unless `array` is a field
        ScalarType type = ScalarType::float32;
        std::size_t tuples = 0, components = 1;

        std::size_t bytes() const noexcept { return tuples * components * size_of(type); }
    };

    virtual ~SurfaceSink();

    /// At least `wanted.bytes()`, aligned for the type, and their owner: by it the memory is known again. Null: there is none,
    /// and the call ends with out_of_memory.
    /// What is given is written and read by many threads during the call, and never written after it. It is given back
    /// when the last copy of the Array is gone, or during the call where that begins anew: of several requests for one
    /// array the last counts. Nothing is asked for an array without tuples.
    ///
    /// Threads   called by one thread of a call at a time
    /// Errors    what it throws ends the call as other exceptions do
    virtual std::shared_ptr<void> take(const Wanted& wanted) = 0;
};

} // namespace isotet
