// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A surface whose arrays have been checked, read as 64-bit numbers and doubles.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <isotet/result.hpp>
#include <isotet/surface.hpp>

#include "grid/cells.hpp"
#include "grid/orientation.hpp"

namespace isotet::checking {

using Corners = std::array<std::uint64_t, 3>;

inline bool has_equal_corners(const Corners& c) { return c[0] == c[1] || c[1] == c[2] || c[2] == c[0]; }

/// The same triangle, its lowest corner first.
inline Corners lowest_first(Corners c) {
    std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
    return c;
}

/// Borrows the surface's arrays.
class Mesh {
public:
    /// Errors   invalid_data when an array has the wrong type or length, a triangle has a vertex out of range, or a
    ///          position is not finite: the lowest-numbered one
    static Result<Mesh> open(const Surface& surface);

    std::uint64_t vertex_count() const noexcept { return vertices_; }
    std::uint64_t triangles() const noexcept { return triangles_; }

    Corners corners(std::uint64_t triangle) const {
        return {indices_[3 * triangle], indices_[3 * triangle + 1], indices_[3 * triangle + 2]};
    }

    core::Point position(std::uint64_t vertex) const { return positions_[vertex]; }

private:
    core::PointReader positions_;
    core::IndexColumn indices_;
    std::uint64_t vertices_ = 0, triangles_ = 0;
};

} // namespace isotet::checking
