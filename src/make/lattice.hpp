// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The points of a made grid: a lattice of side + 1 points along each axis, then the centres of some layers of cubes.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "make/shape.hpp"

namespace isotet::make {

using Position = std::array<float, 3>;

/// Lattice points are numbered along x first, then y, then z; so are cubes. Centres follow the lattice points, in the
/// order of the cubes that use them.
///
/// Guarantees   coordinates are made by +, -, *, / alone: the same bits on every machine
class Lattice {
public:
    Lattice(const Shape& shape, std::uint64_t side, std::uint64_t seed);

    std::uint64_t side() const noexcept { return side_; }
    std::uint64_t points() const noexcept { return corner_points_ + side_ * side_ * centres_before(side_); }
    std::uint64_t corner_points() const noexcept { return corner_points_; }

    Position position(std::uint64_t point) const noexcept;

    /// Numbers of the eight corners (x + 2 y + 4 z) of the cube at (i, j, k), and of its centre (if it has one).
    std::array<std::uint64_t, 9> corners(std::uint64_t i, std::uint64_t j, std::uint64_t k) const noexcept;

private:
    /// Layers below layer k whose cubes use their centres.
    std::uint64_t centres_before(std::uint64_t k) const noexcept {
        return k / centres_before_.size() * centres_per_period_ + centres_before_[k % centres_before_.size()];
    }
    Position moved(const Position& at, std::uint64_t point) const noexcept;

    std::uint64_t side_, seed_, corner_points_;
    bool perturbed_, bent_;
    std::vector<float> across_, up_;            ///< coordinates along x and y, and along z
    std::vector<std::uint64_t> centres_before_; ///< within a period of layers
    std::uint64_t centres_per_period_ = 0;
    std::vector<std::uint64_t> centre_layers_; ///< layers with centres, within a period
};

} // namespace isotet::make
