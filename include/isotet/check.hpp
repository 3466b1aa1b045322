// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet {

/// One place where something was found: a sentence, and where.
struct Finding {
    std::string what; ///< "edge 17-42 is used 1 time forward, 0 backward"
    std::array<double, 3> where{};
};

/// What a surface is, counted. "Used": by the triangles, in one of its two directions. Triangles with two equal corners
/// are counted, and are no part of the surface for all other numbers.
struct SurfaceReport {
    std::uint64_t vertices = 0, triangles = 0;
    std::uint64_t boundary_edges = 0;         ///< used by one triangle
    std::uint64_t inconsistent_edges = 0;     ///< used by more, unequally often in the two directions
    std::uint64_t blamed_edges = 0;           ///< of both, those where the rule asked for does not allow it
    std::uint64_t hanging_edges = 0;          ///< with `grid`: of both, those in a face of a cell that meets smaller ones, or
                                              ///< a larger one: the grid has hanging points there
    std::uint64_t non_manifold_edges = 0;     ///< used by more than two triangles
    std::uint64_t equal_corner_triangles = 0; ///< two equal corners
    std::uint64_t zero_area_triangles = 0;    ///< three different corners, area exactly zero
    std::uint64_t duplicate_triangles = 0;    ///< same corners, same direction as an earlier one
    std::uint64_t blamed_duplicates = 0;      ///< those that the grid does not explain
    std::uint64_t double_sheets = 0;          ///< pairs of triangles on the same corners in opposite directions
    std::uint64_t touching_vertices = 0;      ///< vertices whose triangles are not one fan
    std::uint64_t coincident_vertices = 0;    ///< vertices at the position of an earlier one
    std::uint64_t unused_vertices = 0;
    std::uint64_t collapsed_by_welding = 0; ///< triangles that welding by coordinates removed (formats without
                                            ///< numbers)
    std::uint64_t components = 0;
    std::int64_t euler = 0;          ///< V - E + F, over used vertices
    std::vector<std::int64_t> genus; ///< one for each closed, manifold, oriented component
    double area = 0;
    double volume = 0;             ///< enclosed, positive with normals outward; meaningful if closed
    bool closed = false;           ///< no boundary edge and no inconsistent edge
    bool sound = false;            ///< nothing is blamed: exit 0 of `isotet check`
    bool clean = false;            ///< what `--strict` finds is absent too
    std::vector<Finding> findings; ///< the first few of each kind
};

struct CheckOptions {
    bool closed = false;        ///< blame every edge used unequally often in the two directions
    const Grid* grid = nullptr; ///< blame such edges unless their grid points lie in one boundary face of the valid
                                ///< cells; needs surface.edge_ends
    const PointField* field = nullptr; ///< with `grid`: cells with a corner of no data are not valid
    bool split_cells = false;          ///< with `grid`: the surface was made with PackOptions::split_cells
    bool conforming = false;           ///< with `grid`: it has no hanging points, which are not looked for
    bool weld = false;                 ///< weld first: by edge ends where there are some (pieces), else by exact
                                       ///< coordinates (STL)
    int max_findings = 5;              ///< of each kind
};

/// Measures a surface and looks for what should not be there. An empty surface is closed and clean.
///
/// Edges at hanging points are open because of the grid: they are not blamed, but a surface with them is not clean.
///
/// Blamed are edges as the options ask (without `closed` and `grid`: none), triangles with two equal corners, and
/// triangles that repeat an earlier one, except, with `grid`, on a face that two valid cells use from one side. Cells
/// count as they are stored: each upright, repeated ones once; polyhedra as a session makes them linear. With `weld` all numbers are those after welding.
///
/// Guarantees   the same report for any number of threads
/// Errors   invalid_data when a triangle has a vertex out of range or a position is not finite; invalid_argument when
///          `grid` is given but the surface has no edge ends; cancelled
/// Cost     O(V log V + F log F)
ISOTET_API Result<SurfaceReport> check(const Surface& surface, const CheckOptions& options = {}, const Run& run = {});

} // namespace isotet
