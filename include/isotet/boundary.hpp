// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet {

/// The boundary of a packed grid: all faces that its tets do not use equally often in both directions, holes of no data
/// not counted. Triangles face outwards; a face that is used more than once too often stands there once.
///
/// Guarantees   the same bytes for any thread count; a point's faces are missed with probability 2^-64 (see Method)
/// Cost         O(T); 8 bytes a point while it works, and the surface. Packed files have their boundary, which is read alone;
///              those of version 1.0 are read in parts, twice where they do not fit the memory
/// Errors       out_of_memory; of a grid in a file: as PackedFile; cancelled
/// Threads      safe from many threads on one packed grid
/// Method       a signed sum of hashes a point, 64 bits, says where faces do not cancel; those there are sorted
ISOTET_API Result<Surface> boundary_of(const PackedGrid& packed, const Run& run = {});

/// The same with the fields of packed grids of the same cells and points (with_field(), or of one PackedFile) as point fields,
/// their values as unpack_field() gives them.
/// Errors   as above; invalid_argument: other cells
ISOTET_API Result<Surface> boundary_of(const PackedGrid& packed, const std::vector<PackedGrid>& fields,
                                       const Run& run = {});

/// The boundary of a grid that is not packed: all faces that its tets, repeated ones aside, do not use equally often in
/// both directions: each tetrahedron upright, each other cell as a whole, so a twisted or folded one has no boundary inside.
/// Polyhedra are taken as linearize() makes them. Triangles face outwards; a face that is used more than
/// once too often stands there once. Positions
/// are the grid's, in its type; both edge ends of a vertex are its point.
///
/// A grid of flat cells alone is its own boundary: its cells as triangles, in their order, with source_cells. Quadratic cells
/// are split at their nodes, those of a higher degree taken by their corners.
///
/// Guarantees   the same bytes for any thread count; a point's faces are missed with probability 2^-64 (see Method)
/// Cost         O(n), as survey() with faces; faster than boundary_of() a packed grid
/// Errors       invalid_data as survey(); out_of_memory; cancelled
/// Threads      safe from many threads on one grid
/// Method       a signed sum of hashes a point, 64 bits, says where faces do not cancel; the tets there are dealt into
///              buckets that fit a processor's cache, where their faces are counted
ISOTET_API Result<Surface> boundary_of(const Grid& grid, const Run& run = {});

/// The grid whose boundary is worth looking at: where at least half of the points coincide with others, cells have points of
/// their own (discontinuous Galerkin, MFEM), and every inner face would be boundary; points that differ by roundings are then
/// one. Points and cells keep their numbers, so fields fit both grids. Else, and where cells would collapse, points and cells
/// are the grid's.
///
/// Guarantees   the same for any thread count
/// Cost         estimate_coincident_points(), and where that finds so many merge_points()
/// Errors       as merge_points()
struct DrawnGrid {
    Grid grid;           ///< without fields
    bool joined = false; ///< whether points were joined
};
ISOTET_API Result<DrawnGrid> grid_with_joined_points(const Grid& grid, const Run& run = {});

/// The boundary of a grid of which only active cells are kept (ReadActiveCells::boundary).
///
/// Guarantees   the surface is that of boundary_of() the whole grid
struct StreamedBoundary {
    bool of_steps = false; ///< set before reading: the next step takes it over if it has the same cells and points
    bool is_there = false; ///< set by reading; false: all cells were read
    Surface surface = {};
    std::array<std::uint64_t, 2> print = {}; ///< fingerprint of those cells and points, with `of_steps`
    bool wants_cells = false;                ///< set before reading
    Grid cells =
        {}; ///< then all cells that have a face of it, and others around them, in their order, with their fields
    std::vector<std::uint64_t> numbers = {}; ///< of these cells in the whole grid
};

/// Finds boundaries, and gives the last one again for a grid with the same cells and points, as time steps mostly have.
///
/// Threads   one call at a time
class ISOTET_API KnownBoundary {
public:
    KnownBoundary();
    KnownBoundary(KnownBoundary&&) noexcept;
    KnownBoundary& operator=(KnownBoundary&&) noexcept;
    ~KnownBoundary();

    /// boundary_of(grid). Where cells and points are those of the last call, in the same memory or by a fingerprint of 128
    /// bits, it is what that call gave, in the same memory.
    ///
    /// Cost   a pass over cells and points, and boundary_of() where they are others
    Result<Surface> of(const Grid& grid, const Run& run = {});

private:
    struct Data;
    std::unique_ptr<Data> data_;
};

} // namespace isotet
