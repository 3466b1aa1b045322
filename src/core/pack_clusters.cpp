// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <limits>

#include <fmt/core.h>

#include "core/growth.hpp"
#include "core/pack_draft.hpp"
#include "core/parallel.hpp"

namespace isotet::core {

namespace {

/// Brings the origins of a block's tets, where they are wanted, into the order of its clusters, too.
BlockClusters grow_block(TetBuckets& tets, std::uint64_t first, std::size_t size) {
    Buffer<RankedTet> own(size);
    tets.copy_tets(first, {own.data(), size});
    BlockClusters block = grow_clusters(std::move(own));
    if (tets.has_origins()) {
        std::vector<TetOrigin> origins(size), ordered(size);
        tets.copy_origins(first, origins);
        for (std::size_t i = 0; i < size; ++i) ordered[i] = origins[block.order[i]];
        tets.replace_origins(first, ordered);
    }
    block.order.release();
    return block;
}

std::size_t blocks_for(std::uint64_t tets) { return (tets + tets_per_block - 1) / tets_per_block; }

std::size_t groups_for(std::size_t tets) { return (tets + group_size - 1) / group_size; }

} // namespace

std::size_t blocks_at_once(std::uint64_t tets) {
    const std::size_t most = std::max<std::size_t>(4, blocks_for(tets) / 5);
    return std::min(static_cast<std::size_t>(threads_here()), most);
}

Result<void> form_clusters(TetOrder order, std::uint64_t cells, Draft& draft, const Progress& progress) {
    const bool source_cells = order.tets.has_origins();
    const std::size_t count = order.tets.size();
    const std::size_t block_count = blocks_for(count);
    std::vector<BlockClusters> blocks(block_count);
    std::atomic<std::size_t> next_block{0}, finished{0};
    parallel_each(blocks_at_once(count), 1, [&](std::size_t) {
        for (std::size_t b = next_block++; b < block_count; b = next_block++) {
            if (progress.cancelled()) return;
            try {
                blocks[b] =
                    grow_block(order.tets, b * tets_per_block, std::min(tets_per_block, count - b * tets_per_block));
            } catch (...) {
                next_block = block_count; // nobody begins another one
                throw;
            }
            progress("pack", 0.3 + 0.3 * static_cast<double>(++finished) / static_cast<double>(block_count));
        }
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "packing was cancelled"};
    order.tets.drop_tets();

    // Where each block's clusters, groups and points start.
    struct Start {
        std::size_t cluster = 0, group = 0, local = 0;
    };
    std::vector<Start> starts(block_count + 1);
    for (std::size_t b = 0; b < block_count; ++b) {
        Start next = starts[b];
        const BlockClusters& block = blocks[b];
        next.cluster += block.clusters.size();
        next.local += block.points.size();
        for (const auto& cluster : block.clusters) next.group += groups_for(cluster.tets);
        starts[b + 1] = next;
    }
    const Start total = starts[block_count];
    constexpr std::size_t limit = std::numeric_limits<std::uint32_t>::max();
    if (total.cluster >= limit || total.group >= limit)
        return Error{ErrorCode::invalid_data,
                     fmt::format("the grid makes {} clusters and {} groups of tets, but there can be {} of each",
                                 total.cluster, total.group, limit - 1)};

    Packed& packed = draft.packed;
    packed.headers = SharedBuffer<ClusterHeader>(total.cluster);
    packed.tets = SharedBuffer<StoredTet>(total.group * group_size);
    draft.first_local = Buffer<std::uint64_t>(total.cluster + 1);
    draft.locals = Buffer<std::uint64_t>(total.local);
    draft.first_local[total.cluster] = total.local;
    const bool wide_cells = cells > std::size_t{1} << 32;
    if (source_cells && wide_cells) packed.wide_cell_ids = SharedBuffer<std::uint64_t>(packed.tets.size());
    else if (source_cells) packed.cell_ids = SharedBuffer<std::uint32_t>(packed.tets.size());
    parallel_each(block_count, 1, [&](std::size_t b) {
        const BlockClusters block = std::move(blocks[b]);
        std::vector<TetOrigin> origins(source_cells ? block.tets.size() : 0);
        order.tets.copy_origins(b * tets_per_block, origins);
        Start at = starts[b];
        std::copy(block.points.begin(), block.points.end(), draft.locals.begin() + at.local);
        std::size_t tet = 0;
        for (const auto& cluster : block.clusters) {
            ClusterHeader& header = packed.headers[at.cluster];
            header = {};
            header.tets = static_cast<std::uint16_t>(cluster.tets);
            header.first_group = static_cast<std::uint32_t>(at.group);
            draft.first_local[at.cluster] = at.local;
            const std::size_t groups = groups_for(cluster.tets);
            for (std::size_t i = 0; i < groups * group_size; ++i) {
                const std::size_t from = tet + std::min<std::size_t>(i, cluster.tets - 1);
                const std::size_t to = at.group * group_size + i;
                packed.tets[to] = block.tets[from];
                if (!source_cells) continue;
                const std::uint64_t cell = origins[from].cell();
                if (wide_cells) packed.wide_cell_ids[to] = cell;
                else packed.cell_ids[to] = static_cast<std::uint32_t>(cell);
            }
            tet += cluster.tets;
            at.group += groups;
            at.local += cluster.points;
            ++at.cluster;
        }
    });
    draft.point_of = std::move(order.point_of);
    PackReport& report = packed.report;
    report.clusters = total.cluster;
    report.tets = count;
    report.repeated_tets = order.repeated;
    report.negative_tets = order.orientation.negative + order.orientation.twisted;
    report.inverted_tets = order.inverted;
    report.flat_tets = order.orientation.flat;
    return {};
}

} // namespace isotet::core
