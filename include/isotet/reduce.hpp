// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces with fewer triangles.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet {

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
    double error = 0;                   ///< that was reached, by the same measure
    std::vector<std::string> left_out;  ///< names of what a reduced surface has no place for
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
///              check(); out_of_memory; cancelled, between parts
ISOTET_API Result<ReducedSurface> reduce(const Surface& surface, const ReduceOptions& options = {},
                                         const Run& run = {});

} // namespace isotet
