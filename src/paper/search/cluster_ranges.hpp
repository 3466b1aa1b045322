// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet's own way: the range of each cluster, and of each group of 32 tets in it.
#pragma once

#include "base/buffer.hpp"
#include "packed/tet_table.hpp"
#include "paper/search/search.hpp"

namespace isotet::search {

/// Finds all tets of groups that the isovalue may cut.
/// Cost   O(n) to build; a look at every cluster, and at the groups of those that may be cut; 0.3 bytes a tet
class ClusterRanges final : public Search {
public:
    explicit ClusterRanges(const core::TetTable& table);

    std::uint64_t bytes() const override { return clusters_.bytes() + groups_.bytes(); }
    void find(float isovalue, TetNumbers& found) const override;

private:
    struct Cluster {
        core::CutRange range;
        std::uint32_t first_tet, end_tet, first_group;
    };

    core::Buffer<Cluster> clusters_;
    core::Buffer<core::CutRange> groups_;
};

} // namespace isotet::search
