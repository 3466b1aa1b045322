// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Clusters by growth: the second step of packing. docs/inside/packing.md
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/buffer.hpp"
#include "packed/build/ranked_cell.hpp"
#include "packed/packed.hpp"

namespace isotet::core {

/// Tets or native cells along the curve are cut into blocks of this many, and clusters are grown inside each block on
/// its own: fixed, so that the number of threads does not matter.
constexpr std::size_t cells_per_block = 65536;

/// The clusters of one block. Points of a cluster stand in the order in which they joined; corners of cells are
/// positions in that list.
struct BlockClusters {
    struct Cluster {
        std::array<std::uint16_t, cell_kind_count> cells{}; ///< of each kind
        std::uint32_t points = 0;
    };
    std::vector<Cluster> clusters;
    Buffer<std::uint32_t> order;       ///< the block's cells, cluster by cluster, by kind
    Buffer<StoredTet> words;           ///< in that order: one for a tet, two for any other cell
    std::vector<std::uint32_t> points; ///< ranks, cluster by cluster
};

/// Gathers the tets of a block, sorted by their lowest rank, into clusters of at most max_cluster_points points and
/// max_cluster_tets tets.
///
/// A cluster starts beside the last one and takes, again and again, the point v with the largest
/// gain(v) * (1 + 20 / left(v)): gain = tets that v completes, left = tets of v not yet in a cluster. The second factor
/// favours points that are nearly used up: without it, leftovers become tiny clusters.
///
/// `tets`   at most cells_per_block
/// Cost     O(n) for n tets, about 100 candidates looked at for each point that joins
BlockClusters grow_clusters(Buffer<RankedTet> tets);

/// The same for native cells. A cluster takes, again and again, the cell with the fewest points outside; of these the
/// one that has had so few for longest, so that it grows round the cell where it began.
///
/// Cost     O(n) for n cells
BlockClusters grow_clusters(Buffer<RankedCell> cells);

} // namespace isotet::core
