// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A face as triangles, from the face alone: cells on both sides get the same ones.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/orientation.hpp"

namespace isotet::linear {

/// Positions in a loop.
using LoopTriangle = std::array<std::uint32_t, 3>;

/// Appends the n - 2 triangles of a loop of n >= 3 points: a fan from its first point; where one of these would be thin or
/// turned against the face's normal, ears, the best-shaped first. A fan of what is left where no ear is, and for loops of
/// more than 64 points.
///
/// `loop`     in canonical form (Shell): both cells of a face have it alike
void triangulate(std::span<const std::uint64_t> loop, const core::PointReader& points, std::vector<LoopTriangle>& out);

} // namespace isotet::linear
