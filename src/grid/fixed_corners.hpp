// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "grid/cells.hpp"

namespace isotet::core {

namespace fixed_corners {

constexpr std::uint64_t of(std::uint8_t vtk_type) {
    switch (vtk_type) {
    case 1: return 1;
    case 3: return 2;
    case 5: return 3;
    case 8:
    case 9: return 4;
    default: return static_cast<std::uint64_t>(corners_of(vtk_type));
    }
}

inline constexpr auto by_type = [] {
    std::array<std::uint8_t, 256> all{};
    for (std::size_t type = 0; type < all.size(); ++type)
        all[type] = static_cast<std::uint8_t>(of(static_cast<std::uint8_t>(type)));
    return all;
}();

} // namespace fixed_corners

/// Corners of a contoured type, a vertex, line, triangle, pixel or quadrilateral; 0 for all others.
constexpr std::uint64_t fixed_corners_of(std::uint8_t vtk_type) { return fixed_corners::by_type[vtk_type]; }

} // namespace isotet::core
