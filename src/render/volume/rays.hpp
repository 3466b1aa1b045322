// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The rays through the middles of pixels, and distances along them.
#pragma once

#include <cstdint>

#include <isotet/slice.hpp>

#include "render/space.hpp"

namespace isotet::render {

/// Where the ray of a pixel passes: beside its middle, by less than is seen, since regular grids have faces and edges
/// just there, along which a ray could count twice or not at all.
inline constexpr double ray_x = 0.5 + 3.0 / 32768, ray_y = 0.5 + 2.0 / 32768;

/// A ray: its point at a distance t is `origin` + t * `along`, in the scene.
struct Ray {
    Vector origin{}, along{};
    double stretch = 1; ///< length in the scene for 1 of t
};

/// Distances t are depths along the view from the eye; in parallel pictures those of the depth buffer, 0 to 1.
class Rays {
public:
    Rays(const Sight& sight, std::uint32_t width, std::uint32_t height);

    bool parallel() const { return sight_.parallel; }
    double nearest() const { return nearest_; }
    double farthest() const { return farthest_; }
    const Sight& sight() const { return sight_; }
    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }

    /// `x`, `y`   pixels from the upper left corner of the picture
    Ray at(double x, double y) const;

    /// The distance of a depth in the depth buffer.
    double distance(double depth) const {
        return sight_.parallel ? depth : depth_factor_ / (depth - depth_shift_);
    }

private:
    Sight sight_;
    std::uint32_t width_, height_;
    double nearest_ = 0, farthest_ = 1;
    double depth_shift_ = 0, depth_factor_ = 1; ///< depth = shift + factor / t
    Vector base_{}, per_x_{}, per_y_{}, along_{}; ///< of rays, per_x and per_y for 1 of clip space
};

/// The part of a ray on one side of planes.
struct RayPart {
    double from, to;

    /// Keeps normal . p <= offset, in the scene.
    void cut(const Ray& ray, const Plane& plane);
};

} // namespace isotet::render
