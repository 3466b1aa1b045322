// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Evenly spaced grids of one time step that are boxes on several levels (AMR).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "io/amr/lattice.hpp"

namespace isotet::io::confined {

/// A grid whose points are evenly spaced along each axis.
struct XdmfImage {
    std::array<double, 3> origin{}, spacing{};
    std::array<std::uint64_t, 3> cells{};
};

/// Boxes, and the grid of each, level by level.
struct XdmfLevels {
    amr::Hierarchy hierarchy;
    std::vector<std::size_t> order;
};

/// Nothing where all have one spacing, are no boxes of one lattice, or do not lie in each other.
std::optional<XdmfLevels> levels_of(std::span<const XdmfImage> grids);

} // namespace isotet::io::confined
