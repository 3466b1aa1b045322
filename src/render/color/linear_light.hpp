// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Between colours as pictures have them (sRGB) and linear light, in which surfaces are lit and blended.
#pragma once

#include <array>

#include <isotet/picture.hpp>

namespace isotet::render {

using Light = std::array<float, 3>; ///< red, green, blue

/// A colour in linear light.
Light linear_light(const Color& color);

/// A part of a colour, 0 to 1, in linear light.
double linear_light(double part);

} // namespace isotet::render
