// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
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

/// Area of all triangles, summed in double in a fixed order; NaN when check() would call the surface invalid.
ISOTET_API double area(const Surface& surface);

} // namespace isotet
