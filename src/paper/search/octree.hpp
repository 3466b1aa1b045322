// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The min-max octree of Wilhelms and Van Gelder (1992), over the centroids of tets.
#pragma once

#include <span>
#include <vector>

#include "base/buffer.hpp"
#include "base/radix_sort.hpp"
#include "packed/tet_table.hpp"
#include "paper/search/search.hpp"

namespace isotet::search {

/// Finds all tets of leaves that the isovalue may cut.
///
/// Tets stand along a Hilbert curve through the octree's cells, so every node is a piece of one list. A node is divided
/// when it has more than 32 tets; levels at which all tets fall into one octant are left out.
///
/// Cost   O(n) to build, 36 bytes a tet meanwhile; a look at the nodes that may be cut, and their children;
///        4 bytes a tet and 24 a node
class Octree final : public Search {
public:
    explicit Octree(const core::TetTable& table);

    std::uint64_t bytes() const override { return tets_.bytes() + nodes_.size() * sizeof(Node); }
    void find(float isovalue, TetNumbers& found) const override;

private:
    struct Node {
        core::CutRange range;
        std::uint32_t begin, end;                    ///< in the list of tets
        std::uint32_t first_child = 0, children = 0; ///< they stand together
    };

    void divide(std::span<const core::Keyed> sorted);

    core::Buffer<std::uint32_t> tets_;
    std::vector<Node> nodes_; ///< parents before their children
};

} // namespace isotet::search
