// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The pass over the cells: every cell is checked, and those that the surface may cut go to a cutter.
#pragma once

#include <memory>
#include <vector>

#include "cpu/direct/cutter.hpp"

namespace isotet::cpu::direct {

constexpr std::size_t cells_per_chunk = 1 << 15;

/// Edges found and polygons made of them, chunk by chunk.
template <class Point>
struct CutCells {
    std::vector<Chunk<Point>> chunks;                    ///< and one more, with the totals, once they are counted up
    std::vector<std::shared_ptr<Cutter<Point>>> cutters; ///< keep what the pieces point to

    CutCounts counts() const {
        CutCounts sum;
        for (const auto& cutter : cutters) {
            sum.edges += cutter->counts().edges;
            sum.triangles += cutter->counts().triangles;
            sum.coarse_tets += cutter->counts().coarse_tets;
            sum.left_out += cutter->counts().left_out;
        }
        return sum;
    }
};

/// Passes over all cells. Where context.broken is set, or progress.cancelled(), afterwards nothing else counts. Throws
/// Budget::Exceeded.
template <class Point>
CutCells<Point> cut_cells(CutContext& context, const Progress& progress);

/// Calls sides.saw() for every point that a tet or native cell uses; the cells have been checked.
void see_used_points(const core::CellReader& cells, bool split_cells, Sides& sides);

/// Tets that have corners on both sides, for which there may have to be memory.
std::uint64_t count_cut_tets(const core::CellReader& cells, const Sides& sides);

} // namespace isotet::cpu::direct
