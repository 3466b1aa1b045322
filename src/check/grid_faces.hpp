// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the grid excuses: edges of a surface in its boundary faces, triangles on faces with two tets on one side.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::checking {

/// Up to three different points of the grid, ascending. More never lie in one face.
class PointSet {
public:
    /// False when there would be more than three.
    bool add(std::uint64_t point);

    std::size_t size() const noexcept { return size_; }
    const std::uint64_t* begin() const noexcept { return points_.data(); }
    const std::uint64_t* end() const noexcept { return points_.data() + size_; }

private:
    std::array<std::uint64_t, 3> points_{};
    std::size_t size_ = 0;
};

using Face = std::array<std::uint64_t, 3>;

/// The faces of the valid tets, as isotet stores the tets: each upright, repeated ones once. Only the faces that can
/// contain one of the sets asked for are kept, so the cost is that of one pass over the grid and of the surface's rim.
class GridFaces {
public:
    /// `field`   null: every tet is valid
    ///
    /// Errors    invalid_data as survey(); invalid_argument when the field does not fit the grid; cancelled
    static Result<GridFaces> find(const Grid& grid, const PointField* field, const std::vector<PointSet>& sets,
                                  const Progress& progress);

    /// True when some face that the tets do not use equally often in its two directions has all points of the set.
    bool in_boundary_face(const PointSet& set) const;

    /// True when the set is the corners of a face that tets use twice in one direction.
    bool has_two_tets_on_one_side(const PointSet& set) const;

private:
    std::vector<Face> boundary_;                           ///< ascending
    std::vector<std::array<std::uint64_t, 2>> boundary_edges_; ///< of these faces, ascending
    std::vector<std::uint64_t> boundary_points_;           ///< of these faces, ascending
    std::vector<Face> doubled_;                            ///< faces with two tets on one side, ascending
};

} // namespace isotet::checking
