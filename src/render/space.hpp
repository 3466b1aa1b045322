// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From the user's coordinates to the scene's, and to the clip space of the picture.
#pragma once

#include <array>
#include <cstdint>

#include <isotet/scene.hpp>

#include "render/vector_math.hpp"

namespace isotet::render {

/// A row of a matrix that maps (x, y, z, 1).
struct Row {
    Vector along{};
    double shift = 0;

    double at(const Vector& point) const { return dot(along, point) + shift; }
};

/// How a camera sees the scene: rows of the matrix from the scene to clip space, y downwards, depth 0 to 1.
struct Sight {
    Row x, y, z, w;
    Vector eye{}; ///< where it is, or in which direction if `parallel`
    bool parallel = false;
    Vector up{};
};

/// The user's coordinates, moved and scaled so that the bounds of the scene lie within 1 of 0.
class Space {
public:
    explicit Space(const Box& bounds);

    std::array<double, 3> place(const std::array<double, 3>& point) const;
    double scale() const noexcept { return scale_; }

    /// How the camera sees a picture of `width` x `height`.
    Sight look(const Camera& camera, std::uint32_t width, std::uint32_t height) const;

private:
    std::array<double, 3> centre_{}, half_{}; ///< of the bounds
    double scale_ = 1;
};

} // namespace isotet::render
