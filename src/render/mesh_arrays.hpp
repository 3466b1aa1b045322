// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A surface as renderers hold it, checked.
#pragma once

#include <array>
#include <cstdint>

#include <isotet/result.hpp>
#include <isotet/surface.hpp>

#include "base/buffer.hpp"

namespace isotet::render {

struct MeshArrays {
    core::Buffer<float> positions;           ///< three a vertex, relative to the origin
    core::Buffer<std::uint32_t> triangles;   ///< three a triangle
    core::Buffer<float> normals;             ///< three a vertex, or empty: faces tell
    std::array<double, 3> origin{};
    std::uint32_t vertices = 0, triangle_count = 0;

    /// Errors   invalid_argument when arrays have a wrong shape or are too long; invalid_data when a triangle has a
    ///          vertex that is not there, or a vertex is not finite
    static Result<MeshArrays> of(const Surface& surface);

private:
    Result<void> take_positions(const Surface& surface);
    Result<void> take_triangles(const Surface& surface);
};

} // namespace isotet::render
