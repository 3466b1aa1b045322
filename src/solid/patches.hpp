// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which named part of the boundary, and which 2D cell, a face of the boundary lies on.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/result.hpp>

#include "solid/boundary_faces.hpp"

namespace isotet::solid {

/// The faces of Grid::patches, then the 2D cells, each as a set of points.
class PatchFaces {
public:
    /// `grid`    as the user has it: before its cells become linear
    /// Errors    invalid_data: as check_patches()
    static Result<PatchFaces> of(const Grid& grid);

    /// Finds for each face of the boundary the first patch and the first 2D cell that have all its points. Where cells
    /// were made linear, a derived point counts as those that it is made of.
    ///
    /// `linear`   null where the grid's cells were linear
    void match(const LinearGrid* linear, BoundaryFaces& boundary) const;

    bool empty() const { return offsets_.size() == 1; }

private:
    void add(std::vector<std::uint64_t> points, std::int64_t patch, std::int64_t cell);
    void grow_to_polyhedra(const Grid& grid);
    bool has_all(std::size_t face, std::span<const std::uint64_t> points) const;
    std::span<const std::uint64_t> points_of(std::size_t face) const {
        return std::span(points_).subspan(offsets_[face], offsets_[face + 1] - offsets_[face]);
    }

    std::vector<std::uint64_t> points_, offsets_{0}; ///< of each face ascending
    std::vector<FaceMark> marks_;                    ///< one a face, one of both is there
};

} // namespace isotet::solid
