// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Quadratic cells as linear tets, as many as a tolerance needs, with a proven bound.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

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

} // namespace isotet
