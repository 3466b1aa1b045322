// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Faces of tets, and what they tell of a grid: where its boundary is, and which tets occur twice.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>

#include "core/cells.hpp"
#include "core/orientation.hpp"
#include "core/tet_survey.hpp"

namespace isotet::core {

/// A face by its three points, ascending, and how often tets use it as it stands and mirrored.
struct StoredFace {
    std::array<std::uint64_t, 3> points;
    std::uint32_t forward = 0, backward = 0;
};

/// All faces of some stored tets, each once, ascending. 128 bytes a tet while it works: for few tets.
std::vector<StoredFace> faces_of(const std::vector<Tet>& tets);

/// What all stored tets of a grid say.
struct FaceSurvey {
    std::uint64_t repeated = 0;       ///< tets with the corners of an earlier one; all else is counted without them
    std::uint64_t boundary_faces = 0; ///< faces that the tets do not use equally often in both directions
    std::uint64_t inverted = 0;
    Orienter::Counts orientation;
};

/// Surveys a checked grid of any size: points are dealt out into so many hands that the faces (or tets) with their
/// lowest point in one hand fit `memory` bytes, and each hand takes a pass over the cells.
///
/// Guarantees   the same counts for any thread count and any `memory`
/// Cost         O(T log T) and a pass over the cells a hand; 96 T / `memory` hands
/// Errors       cancelled
Result<FaceSurvey> survey_faces(const Grid& grid, const CellReader& cells, const TetSurvey& survey,
                                std::uint64_t memory, const Progress& progress);

} // namespace isotet::core
