// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The tets of a grid as packing stores them (upright, canonical, repeated ones dropped) but in the user's order and with the
// user's point numbers; and their boundary faces. For checks: 32 bytes a tet.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <isotet/grid.hpp>

#include "core/cells.hpp"
#include "core/tet_order.hpp"

namespace isotet::core {

struct StoredTets {
    std::vector<Tet> tets;
    std::uint64_t repeated = 0, negative = 0, inverted = 0, flat = 0;
};

/// The stored form of every tet of a checked grid. Deterministic. Cost: O(T log T).
StoredTets stored_tets(const Grid& grid, const CellReader& cells, const TetSurvey& survey);

/// A face by its three points, ascending, and how often tets use it as it stands and mirrored.
struct StoredFace {
    std::array<std::uint64_t, 3> points;
    std::uint32_t forward = 0, backward = 0;
};

/// All faces of the tets, each once, ascending.
std::vector<StoredFace> faces_of(const std::vector<Tet>& tets);

/// The faces that the tets do not use equally often in both directions, ascending.
std::vector<StoredFace> boundary_faces(const std::vector<Tet>& tets);

} // namespace isotet::core
