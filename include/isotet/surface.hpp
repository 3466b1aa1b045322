// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <isotet/array.hpp>

namespace isotet {

/// A field on a surface. What the user had is `values / scale + offset`: writers apply it, in double.
struct SurfaceField {
    std::string name;
    Array values;
    double offset = 0;
    double scale = 1; ///< a power of two
};

enum class Normals : std::uint8_t { none, gradient, face };

/// Triangles on welded vertices. V vertices, F triangles.
///
/// `positions`     float32 (float64 from a double packing), 3 components, V tuples, relative to `origin`
/// `triangles`     uint32 (uint64 from 2^32 vertices on), 3 components, F tuples; counter-clockwise seen from the side
///                 of higher values
/// `normals`       empty, or float32, 3 components: V tuples (gradient) or F tuples (face); unit length, or zero where
///                 nothing defines one; towards higher values
/// `edge_ends`     empty, or int64, 2 components, V tuples: the user's numbers of the points between which the vertex
///                 lies, the one below first; both the same for a vertex at a tied point
/// `edge_weights`  empty, or float32 (float64), V tuples: 0 at the first end, 1 at the second
/// `source_cells`  empty, or int64, F tuples: the user's cell of each triangle
struct Surface {
    std::array<double, 3> origin{};
    Array positions;
    Array triangles;
    Normals normals_kind = Normals::none;
    Array normals;
    Array edge_ends;
    Array edge_weights;
    Array source_cells;
    std::vector<SurfaceField> point_fields; ///< V tuples each
    std::vector<SurfaceField> cell_fields;  ///< F tuples each, in the user's own type

    std::size_t vertices() const noexcept { return positions.tuples(); }
    std::size_t triangle_count() const noexcept { return triangles.tuples(); }
};

/// Joins surfaces into one, vertices and triangles one after another; fields that not all of them have are dropped,
/// empty surfaces aside. Origins that differ are added to the positions, in double.
/// With `isovalues` (one a surface) the result has a cell field "isovalue", float64.
Surface join(const std::vector<Surface>& surfaces, const std::vector<double>& isovalues);

/// Area of all triangles, summed in double in a fixed order; NaN when check() would call the surface invalid.
double area(const Surface& surface);

} // namespace isotet
