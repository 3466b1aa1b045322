// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Positions of vertices for formats that hold float32 only.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "io/write/write_formats.hpp"

namespace isotet::io {

/// Where positions in float32 count from: 0, unless so far from it triangles would collapse; then the surface's middle.
struct FloatPositions {
    std::array<double, 3> origin{};

    std::array<float, 3> at(const Surface& surface, std::uint64_t vertex) const;
};

/// Notes an origin that is not 0, and how far positions were rounded. `format` is the format's name in these notes.
FloatPositions float_positions(const SurfaceToWrite& input, std::string_view format);

} // namespace isotet::io
