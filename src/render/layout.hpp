// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The structs that cross to the drawing shaders (kernels/scene.h), checked, and how they are filled.
#pragma once

#include <array>

#include <isotet/picture.hpp>

#include "render/kernels/scene.h"
#include "vulkan/engine/layout.hpp"

namespace isotet::render {

namespace layout {

static_assert(sizeof(View) == 64 + 12 + 4 + 12 + 4 * 4 + 4 * 8 + 12 + 4);
static_assert(sizeof(Mesh) == 8 * 8 + 3 * 12 + 3 * 4 && sizeof(Lines) == 8 + 12 + 4);
static_assert(sizeof(FragmentList) == 4 && sizeof(Fragment) == 16);
static_assert(sizeof(DrawPush) == 16 && sizeof(ResolvePush) == 8);

inline vec3 vector(const std::array<double, 3>& v) {
    return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

} // namespace layout

/// A colour in linear light.
layout::vec3 linear_light(const Color& color);

} // namespace isotet::render
