// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which faces cover larger ones, and which points lie on edges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "grid/orientation.hpp"
#include "linear/hanging/open_faces.hpp"
#include "linear/hanging/split_edges.hpp"

namespace isotet::linear {

/// A face, and those that cover it, all by their numbers among the open faces.
struct Cover {
    std::size_t face = 0;
    std::vector<std::uint32_t> by;                   ///< ascending
    std::vector<double> distances;                   ///< of these from the face, in its extents
    std::vector<std::vector<std::uint64_t>> between; ///< points between each corner and the next, as `by` has them
    bool is_whole = false;                          ///< they have its outline
};

struct Covers {
    std::vector<Cover> whole; ///< by ascending face
    SplitEdges edges;
    std::uint64_t open = 0; ///< faces on which smaller ones lie that do not cover them
};

/// A face is covered by smaller open faces of other cells that face the other way, whose middles are over it, and whose
/// edges but for those between them are its outline, with more points than its corners. Faces whose smaller ones have
/// hanging points themselves come after these.
///
/// `points`     of the grid; borrowed by the result
/// Guarantees   the same for any thread count
/// Cost         O(n log n)
/// Errors       cancelled
Result<Covers> find_covers(const OpenFaces& faces, const core::CellReader& cells, const core::PointReader& points,
                           const Progress& progress);

/// Whether some face lies on larger ones, by their places alone: for faces of some cells of a grid.
bool has_smaller_faces(const OpenFaces& faces, const core::CellReader& cells, const core::PointReader& points);

} // namespace isotet::linear
