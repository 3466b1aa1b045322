// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The colour of a surface at a place of the picture; what kernels/mesh.glsl computes.
#pragma once

#include <span>

#include "render/cpu/sheet.hpp"

namespace isotet::render {

struct Shade {
    Light color{};
    float opacity = 1;
};

/// `x`, `y`   in samples, from the upper left corner of the picture; inside the triangle
struct ShadedPlace {
    const Sheet* sheet;
    std::uint32_t triangle;
    double x, y;
};

/// The shades of many places.
void shade(std::span<const ShadedPlace> places, const Sight& sight, std::span<Shade> shades);

/// How much light a sheet gives that turns `towards`, which faces the eye at `to_eye`; both are unit vectors.
float light_on(const std::array<float, 3>& towards, const std::array<float, 3>& to_eye, const Sight& sight);

} // namespace isotet::render
