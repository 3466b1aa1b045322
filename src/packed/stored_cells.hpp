// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The stored cells of a cluster as tets, whatever their kind: for what works on tets alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "grid/cell/split.hpp"
#include "packed/packed.hpp"

namespace isotet::core {

/// A stored cell by numbers of its points that split it as the user's grid has it.
/// `locals`   of its cluster, as local_points() gives them
inline WholeCell ranked_cell(const Packed& packed, const std::uint64_t* locals, const StoredCell& cell) {
    WholeCell out{cell.kind, {}};
    for (std::size_t k = 0; k < cell.corners.size(); ++k)
        out.corners[k] = packed.rank_of_point(locals[cell.corners[k]]);
    return out;
}

/// Calls f(corners, word) with the local indices of every tet of a cluster: its stored tets, then those into which the
/// other cells are split, and the first word of the cell.
template <class F>
void for_tets(const Packed& packed, std::size_t cluster, const F& f) {
    std::size_t word = 0;
    for (const StoredTet& tet : packed.cluster_tets(cluster)) f(tet.corners, word++);
    if (packed.headers[cluster].others() == 0) return;
    std::array<std::uint64_t, max_cluster_points> locals;
    local_points(packed, cluster, locals.data());
    packed.for_other_cells(cluster, [&](const StoredCell& cell) {
        for (const auto& tet : split_locally(ranked_cell(packed, locals.data(), cell)))
            f(std::array<std::uint8_t, 4>{cell.corners[tet[0]], cell.corners[tet[1]], cell.corners[tet[2]],
                                          cell.corners[tet[3]]},
              cell.word);
    });
}

} // namespace isotet::core
