// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "paper/search/cluster_ranges.hpp"

#include <algorithm>

#include "base/parallel.hpp"

namespace isotet::search {

using core::group_size;

ClusterRanges::ClusterRanges(const core::TetTable& table) : clusters_(table.clusters()) {
    std::uint32_t groups = 0;
    for (std::size_t c = 0; c < clusters_.size(); ++c) {
        clusters_[c] = {{}, table.first_tet[c], table.first_tet[c + 1], groups};
        groups +=
            static_cast<std::uint32_t>((clusters_[c].end_tet - clusters_[c].first_tet + group_size - 1) / group_size);
    }
    groups_ = core::Buffer<core::CutRange>(groups);
    core::parallel_each(clusters_.size(), 64, [&](std::size_t c) {
        Cluster& cluster = clusters_[c];
        core::CutRange* group = groups_.data() + cluster.first_group;
        for (std::uint32_t begin = cluster.first_tet; begin < cluster.end_tet; begin += group_size, ++group) {
            *group = {};
            for (std::uint32_t tet = begin; tet < std::min<std::uint32_t>(begin + group_size, cluster.end_tet); ++tet)
                group->take_in(table.range(tet));
            cluster.range.take_in(*group);
        }
    });
}

void ClusterRanges::find(float isovalue, TetNumbers& found) const {
    found.clear();
    for (const Cluster& cluster : clusters_) {
        if (!cluster.range.holds(isovalue)) continue;
        const core::CutRange* group = groups_.data() + cluster.first_group;
        for (std::uint32_t begin = cluster.first_tet; begin < cluster.end_tet; begin += group_size, ++group) {
            if (!group->holds(isovalue)) continue;
            const std::uint32_t end = std::min<std::uint32_t>(begin + group_size, cluster.end_tet);
            for (std::uint32_t tet = begin; tet < end; ++tet) found.push_back(tet);
        }
    }
}

} // namespace isotet::search
