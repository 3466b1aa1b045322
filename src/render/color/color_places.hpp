// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Values and colour maps as renderers hold them.
#pragma once

#include <cstdint>
#include <functional>

#include <isotet/result.hpp>
#include <isotet/scene.hpp>

#include "base/buffer.hpp"

namespace isotet::render {

inline constexpr std::uint32_t entries_per_map = 1024;

/// The colours of a scale in linear light: red, green and blue of each entry.
core::Buffer<float> color_table(const ColorScale& scale);

/// `count` values, the i-th of them the one that `number(i)` says. Places in the map where the scale is linear; where it
/// is logarithmic values / lower end, so that the logarithm can be taken of what was interpolated.
///
/// Errors   invalid_argument when `values` has several components, or the scale is wrong
Result<core::Buffer<float>> color_places(const Array& values, std::uint64_t count,
                                         const std::function<std::uint64_t(std::uint64_t)>& number,
                                         const ColorScale& scale);

/// What turns the logarithm of a value / lower end into a place; 0 where the scale is linear.
float log_factor_of(const ColorScale& scale);

} // namespace isotet::render
