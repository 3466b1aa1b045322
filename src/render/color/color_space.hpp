// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Colours between two of a colour map.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace isotet::render {

enum class ColorSpace : std::uint8_t { rgb, hsv, hsv_wrapped, lab, diverging, step };

using Rgb = std::array<double, 3>; ///< of sRGB, 0 to 1

/// The colour at `part` of the way from one to another, as ParaView has it. Diverging: Moreland 2009, "Diverging Color
/// Maps for Scientific Visualization".
Rgb color_between(ColorSpace space, const Rgb& from, const Rgb& to, double part);

/// By the name that ParaView's files have; nothing: it is none.
std::optional<ColorSpace> parse_color_space(std::string_view name, bool wraps);

} // namespace isotet::render
