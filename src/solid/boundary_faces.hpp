// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The boundary of a grid as its cells have it: triangles and quadrilaterals, which isosurfaces meet along known edges.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::solid {

/// What of the grid lies on a face of the boundary; -1: nothing (patches.hpp).
struct FaceMark {
    std::int64_t patch = -1; ///< of Grid::patches
    std::int64_t cell = -1;  ///< the first 2D cell

    bool any() const { return patch >= 0 || cell >= 0; }
};

/// A face by places in BoundaryFaces::points, counter-clockwise seen from outside.
struct BoundaryFace {
    std::array<std::uint32_t, 4> places{};
    std::uint32_t count = 0; ///< 3 or 4
    std::uint64_t cell = 0;  ///< of the grid
    FaceMark mark = {};

    std::span<const std::uint32_t> all() const { return {places.data(), count}; }
};

/// A face inside the grid: cells beside each other do not share it.
enum class Wall : std::uint8_t {
    none,
    doubled, ///< back to back on another one, by its coordinates: points are doubled
    unfit    ///< on smaller ones, or on a larger one
};

struct BoundaryFaces {
    std::vector<BoundaryFace> faces;
    std::vector<std::uint64_t> points; ///< numbers in the grid, ascending
    std::vector<Wall> walls;           ///< one a face; empty: none is one
};

enum class CellMode : std::uint8_t {
    native, ///< cells as they are
    split   ///< as tets
};

/// The faces that stored cells with data do not use equally often in both directions, in a defined order. A face that is
/// used n times too often in one direction stands there n times: so the boundary of any set of cells is closed.
///
/// `grid`     linear cells without point numbers
/// `values`   one scalar a point: cells with a corner that is NaN do not count
/// Guarantees the same for any thread count; a point's faces are missed with probability 2^-64
/// Cost       two passes over the cells, 8 bytes a point, 40 bytes a face of cells at the boundary
/// Errors     invalid_data as survey(); out_of_memory; cancelled
Result<BoundaryFaces> find_boundary_faces(const Grid& grid, const Array& values, CellMode mode,
                                          const Progress& progress);

/// Finds BoundaryFaces::walls.
///
/// `grid`   that of the boundary
/// Cost     O(n log n) in the faces of the boundary
/// Errors   cancelled
Result<void> find_walls(const Grid& grid, BoundaryFaces& boundary, const Progress& progress);

} // namespace isotet::solid
