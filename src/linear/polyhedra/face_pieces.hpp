// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A face in triangles and quadrilaterals, from the face alone: cells on both sides get the same ones.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "grid/orientation.hpp"

namespace isotet::linear {

/// A triangle or a quadrilateral, as positions in a loop. A quadrilateral's diagonal from its first corner to its third makes
/// two triangles that are as good as any.
struct LoopPiece {
    std::array<std::uint32_t, 4> corners;
    std::uint32_t count; ///< of corners: 3 or 4
};

/// Appends the pieces of a loop of n >= 3 points. A loop of four is one quadrilateral. Others are a fan from the first point,
/// in which two triangles that follow each other are one quadrilateral where the other diagonal of it would do as well;
/// where a triangle of the fan would be thin or turned against the face's normal, ears, the best-shaped first. A fan of
/// what is left where no ear is; of triangles alone for loops of more than 64 points.
///
/// `loop`     in canonical form (Shell): both cells of a face have it alike
void cut_face(std::span<const std::uint64_t> loop, const core::PointReader& points, std::vector<LoopPiece>& out);

} // namespace isotet::linear
