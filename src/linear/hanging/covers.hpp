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
    struct Part {
        std::uint32_t face;
        double distance; ///< of its middle from the larger one, in extents of that
    };
    struct OnEdge {
        std::uint32_t edge; ///< from this corner to the next
        std::uint64_t point;
    };

    std::size_t face = 0;
    std::vector<Part> by;        ///< ascending
    std::vector<OnEdge> between; ///< points on the edges, as `by` has them, around the face
    bool is_whole = false;       ///< they have its outline
};

struct Covers {
    std::vector<Cover> whole; ///< by ascending face
    SplitEdges edges;
    std::vector<Cover> open = {}; ///< faces on which smaller ones lie that do not cover them
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

} // namespace isotet::linear
