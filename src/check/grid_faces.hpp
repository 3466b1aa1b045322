// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the grid excuses: edges of a surface in its boundary faces, triangles on faces with two cells on one side.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::checking {

/// Up to four different points of the grid, ascending. More never lie in one face.
class PointSet {
public:
    /// False when there would be more than four.
    bool add(std::uint64_t point);

    std::size_t size() const noexcept { return size_; }
    const std::uint64_t* begin() const noexcept { return points_.data(); }
    const std::uint64_t* end() const noexcept { return points_.data() + size_; }

    friend auto operator<=>(const PointSet&, const PointSet&) = default;

private:
    std::array<std::uint64_t, 4> points_{};
    std::size_t size_ = 0;
};

/// All sets of points that lie in one of some faces.
class SetsOfFaces {
public:
    /// `around`   the corners of a face; a triangle has one of them twice
    void add(const std::array<std::uint64_t, 4>& around);
    void sort(); ///< once all have been added

    bool hold(const PointSet& set) const;

private:
    std::vector<PointSet> sets_;
};

/// The faces of the valid cells, as isotet stores them: each upright, repeated ones once. Only the faces that can contain
/// one of the sets asked for are kept, so the cost is that of one pass over the grid and of the surface's rim.
class GridFaces {
public:
    /// `field`         null: every cell is valid
    /// `split_cells`   as PackOptions::split_cells
    /// `conforming`    no faces are looked for that lie on one another
    ///
    /// Errors    invalid_data as survey(); invalid_argument when the field does not fit the grid; cancelled
    static Result<GridFaces> find(const Grid& grid, const PointField* field, bool split_cells, bool conforming,
                                  const std::vector<PointSet>& sets, const Progress& progress);

    /// True when some face that the cells do not use equally often in its two directions has all points of the set.
    bool in_boundary_face(const PointSet& set) const { return boundary_.hold(set); }

    /// True when such a face lies on smaller ones, or on a larger one.
    bool in_hanging_face(const PointSet& set) const { return hanging_.hold(set); }

    /// True when three points lie in a face that cells use twice in one direction.
    bool has_two_cells_on_one_side(const PointSet& set) const { return set.size() == 3 && doubled_.hold(set); }

private:
    SetsOfFaces boundary_, hanging_, doubled_;
};

} // namespace isotet::checking
