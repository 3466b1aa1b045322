// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A packed grid without the arrays that it was made of: surfaces of any field, slices.
#pragma once

#include <utility>

#include <isotet/extract.hpp>
#include <isotet/isosurface_scene.hpp>
#include <isotet/pack.hpp>

namespace isotet::view {

/// Threads   one call at a time
class PackedSource {
public:
    /// `packed`   of a grid of linear cells, for `field`, with source cells
    PackedSource(const PackedGrid& packed, PointField field) : packed_(packed), field_(std::move(field)) {}

    /// `options`   fields that the surface carries
    /// Cost     where `field` is not that of the call before, PackedGrid::with_field(), too
    /// Errors   as PackedGrid::with_field() and extract()
    Result<Surface> isosurface(const PointField& field, double isovalue, const ExtractOptions& options, const Run& run);

    /// What slice_of() gives, in another order. Cost and errors as above
    Result<Surface> slice(const Array& points, const Plane& plane, const ExtractOptions& options, const Run& run) const;

private:
    PackedGrid packed_;
    PointField field_;
};

/// A grid of a few cells of another, spread evenly over their numbers; the same points. All cells where there are no more.
struct CellSample {
    Grid grid;
    double cells_each = 1; ///< of the grid, for each one here
};
/// Cost     a few milliseconds
/// Errors   out_of_memory is thrown
CellSample sample_of_cells(const Grid& grid);

} // namespace isotet::view
