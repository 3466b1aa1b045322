// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The vertices of isosurfaces that lie on edges of the boundary, found by the ends of these.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <isotet/surface.hpp>

#include "solid/boundary_faces.hpp"

namespace isotet::solid {

/// The points of a boundary by their numbers in the grid.
class BoundaryPoints {
public:
    BoundaryPoints() = default;
    /// Cost   a bit a point of the grid
    BoundaryPoints(const BoundaryFaces& boundary, std::uint64_t grid_points);

    bool has(std::uint64_t point) const {
        return point / 64 < bits_.size() && (bits_[point / 64] >> point % 64 & 1) != 0;
    }

private:
    std::vector<std::uint64_t> bits_;
};

/// Vertices of one isosurface whose edge ends are points of the boundary.
class Rim {
public:
    static constexpr std::uint32_t no_vertex = std::numeric_limits<std::uint32_t>::max();

    Rim() = default;
    /// `surface`   with edge ends
    Rim(const Surface& surface, const BoundaryPoints& points);

    /// The vertex on the edge between two points of the grid; of a tied point: both are that point.
    std::uint32_t find(std::uint64_t below, std::uint64_t above) const;

private:
    struct Entry {
        std::uint64_t below, above;
        std::uint32_t vertex;
    };
    std::vector<Entry> entries_; ///< ascending by ends
};

} // namespace isotet::solid
