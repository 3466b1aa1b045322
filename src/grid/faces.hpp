// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Faces of tets, and what they tell of a grid: where its boundary is, and which tets occur twice.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/progress.hpp>

#include "base/buffer.hpp"
#include "grid/cells.hpp"
#include "grid/tet_survey.hpp"

namespace isotet::core {

/// A face by its three points, ascending, and how often tets use it as it stands and mirrored.
struct StoredFace {
    std::array<std::uint64_t, 3> points;
    std::uint32_t forward = 0, backward = 0;
};

/// All faces of some stored tets, each once, ascending. 128 bytes a tet while it works: for few tets.
std::vector<StoredFace> faces_of(const std::vector<Tet>& tets);

struct FaceSurveyOptions {
    std::uint64_t memory = std::uint64_t{1} << 30; ///< bytes that it should not take more of
    bool wide = false;                             ///< point numbers of 64 bits, even where 32 would do
    std::uint64_t most_faces = 0;                  ///< so many boundary faces are kept, none where there are more
};

/// A face of the boundary: points in ascending order, and whether it faces outwards in the mirrored order.
struct BoundaryFace {
    std::array<std::uint64_t, 3> points;
    bool mirrored = false;
};

inline bool is_mirrored(const BoundaryFace& face) { return face.mirrored; }

struct FaceSurvey {
    std::uint64_t repeated = 0;       ///< tets with the corners of an earlier one
    std::uint64_t boundary_faces = 0; ///< faces that tets but repeated ones do not use equally often in both directions
    std::vector<BoundaryFace> faces;  ///< these, if they are kept: ascending within ranges of their lowest points
};

/// Counts repeated tets and boundary faces of a checked grid of any size.
///
/// Sums of hashes (face_sums.hpp) say at which points faces may be unbalanced or tets repeated, unless they take more
/// than `memory`. The tets there are dealt by their two lowest points into buckets that fit a processor's cache, where
/// they and their faces are counted in tables. Where all buckets together take more than `memory`, so many at a time as
/// fit.
///
/// Guarantees   the same counts for any thread count and any options, but for sums that are 0 by chance: 2^-64 a point
/// Cost         a pass over the cells and 17 bytes a point for the sums; two passes for each time, and up to 32 bytes
///              for each tet at the points that are left (twice that from 2^31 points on): few beside the boundary
/// Errors       cancelled
Result<FaceSurvey> survey_faces(const Grid& grid, const CellReader& cells, const TetSurvey& survey,
                                const FaceSurveyOptions& options, const Progress& progress);

/// The faces that survey_faces() counts, each once, ascending within ranges of their lowest points; the same
/// guarantees, cost and errors, and 32 bytes a face.
Result<std::vector<BoundaryFace>> find_boundary_faces(const Grid& grid, const CellReader& cells,
                                                      const TetSurvey& survey, const FaceSurveyOptions& options,
                                                      const Progress& progress);

/// The same of faces whose lowest point is doubted, which all of them are (cell_sums.hpp).
///
/// `doubted`   by point
/// `cells`     at least those with such points; in the order of all
/// `survey`    of all cells: how tets are turned
Result<std::vector<BoundaryFace>> find_boundary_faces_at(Buffer<std::uint8_t> doubted, const Grid& grid,
                                                         const CellReader& cells, const TetSurvey& survey,
                                                         const FaceSurveyOptions& options, const Progress& progress);

} // namespace isotet::core
