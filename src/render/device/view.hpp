// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How a part of a picture is seen, as shaders have it.
#pragma once

#include <cstdint>

#include "render/layout.hpp"
#include "render/space.hpp"

namespace isotet::render {

/// A rectangle of the picture, in pixels.
struct Part {
    std::uint32_t x = 0, y = 0, width = 0, height = 0;
};

/// Fills what the camera sees of a part of the picture, which then fills clip space.
void fill(layout::View& view, const Sight& sight, const PictureOptions& options, const Part& part);

} // namespace isotet::render
