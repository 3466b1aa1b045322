// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Boxes of cells on several levels, which share one lattice: the points of the finest level.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

namespace isotet::io::amr {

using Place = std::array<std::int64_t, 3>;

/// First and last cell along each axis, by the numbers of its level.
struct CellBox {
    Place first{}, last{};

    std::uint64_t cells(std::size_t axis) const { return static_cast<std::uint64_t>(last[axis] - first[axis]) + 1; }
    std::uint64_t cells() const { return cells(0) * cells(1) * cells(2); }
    std::uint64_t points() const { return (cells(0) + 1) * (cells(1) + 1) * (cells(2) + 1); }
    /// Where a cell stands in the arrays of the box, x fastest.
    std::size_t cell_at(const Place& cell) const {
        const auto along = [&](std::size_t axis) { return static_cast<std::uint64_t>(cell[axis] - first[axis]); };
        return static_cast<std::size_t>((along(2) * cells(1) + along(1)) * cells(0) + along(0));
    }
    std::size_t point_at(const Place& point) const {
        const auto along = [&](std::size_t axis) { return static_cast<std::uint64_t>(point[axis] - first[axis]); };
        return static_cast<std::size_t>((along(2) * (cells(1) + 1) + along(1)) * (cells(0) + 1) + along(0));
    }
};

struct Level {
    std::array<double, 3> spacing{};
    std::vector<CellBox> boxes;
};

/// As a file states them, the coarsest first. Point (0, 0, 0) of each level is at the origin.
struct Hierarchy {
    std::array<double, 3> origin{};
    std::vector<Level> levels;
};

/// Points of all levels by the finest one's steps.
class ISOTET_API Lattice {
public:
    /// Errors   invalid_data: no box; an origin, spacing or box that is none; a spacing that is no whole multiple of
    ///          the next level's; more points than 62 bits number
    static Result<Lattice> make(const Hierarchy& hierarchy);

    std::size_t levels() const { return steps_.size(); }
    /// Of the finest level, in one of `level`.
    std::int64_t steps(std::size_t level, std::size_t axis) const { return steps_[level][axis]; }
    /// Cells of the finest level in one of `level`.
    std::uint64_t volume(std::size_t level) const;
    /// A point of a level as one of the lattice.
    Place from_level(std::size_t level, const Place& point) const {
        return {point[0] * steps_[level][0], point[1] * steps_[level][1], point[2] * steps_[level][2]};
    }
    /// A number for each point of the lattice, below 2^62.
    std::uint64_t number_of(const Place& point) const {
        const auto along = [&](std::size_t axis) { return static_cast<std::uint64_t>(point[axis] - first_[axis]); };
        return (along(2) * size_[1] + along(1)) * size_[0] + along(0);
    }
    /// The same coordinates whatever level a point is of.
    double coordinate(std::int64_t along, std::size_t axis) const {
        return origin_[axis] + spacing_[axis] * (static_cast<double>(along) / static_cast<double>(steps_[0][axis]));
    }

private:
    std::array<double, 3> origin_{}, spacing_{}; ///< of the coarsest level
    std::vector<Place> steps_;
    Place first_{};
    std::array<std::uint64_t, 3> size_{};
};

} // namespace isotet::io::amr
