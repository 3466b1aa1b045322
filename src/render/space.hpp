// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From the user's coordinates to the scene's, and to the clip space of a part of the picture.
#pragma once

#include <array>
#include <cstdint>

#include <isotet/camera.hpp>

#include "render/kernels/scene.h"

namespace isotet::render {

/// A rectangle of the picture, in pixels.
struct Part {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

/// The user's coordinates, moved and scaled so that the bounds of the scene lie within 1 of 0.
class Space {
public:
    explicit Space(const Box& bounds);

    std::array<double, 3> place(const std::array<double, 3>& point) const;
    double scale() const noexcept { return scale_; }

    /// Fills how the camera sees a part of a picture of `width` x `height`.
    void look(const Camera& camera, std::uint32_t width, std::uint32_t height, const Part& part,
              layout::View& view) const;

private:
    std::array<double, 3> centre_{}, half_{}; ///< of the bounds
    double scale_ = 1;
};

} // namespace isotet::render
