// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <limits>
#include <span>

#include <fmt/core.h>

#include "base/parallel.hpp"
#include "base/workers.hpp"
#include "packed/build/growth.hpp"
#include "packed/build/pack_draft.hpp"

namespace isotet::core {

namespace {

/// Brings the origins of a block's cells, where they are wanted, into the order of its clusters, too.
template <class Item>
BlockClusters grow_block(RankedBuckets<Item>& cells, std::uint64_t first, std::size_t size) {
    Buffer<Item> own(size);
    cells.copy_items(first, {own.data(), size});
    BlockClusters block = grow_clusters(std::move(own));
    if (cells.has_origins()) {
        std::vector<CellOrigin> origins(size), ordered(size);
        cells.copy_origins(first, origins);
        for (std::size_t i = 0; i < size; ++i) ordered[i] = origins[block.order[i]];
        cells.replace_origins(first, ordered);
    }
    block.order.release();
    return block;
}

std::size_t blocks_for(std::uint64_t cells) { return (cells + cells_per_block - 1) / cells_per_block; }

ClusterHeader header_of(const BlockClusters::Cluster& cluster) {
    ClusterHeader header{};
    header.cells = cluster.cells;
    return header;
}

/// Where a block's clusters, groups, words and points start.
struct Start {
    std::size_t cluster = 0, group = 0, word = 0, local = 0;
};

/// Copies the clusters of one block to where they belong.
class BlockWriter {
public:
    /// `origins`   of the block's cells, or none
    BlockWriter(const BlockClusters& block, std::span<const CellOrigin> origins, Draft& draft)
        : block_(block), origins_(origins), draft_(draft), packed_(draft.packed) {}

    void write(Start at) {
        std::copy(block_.points.begin(), block_.points.end(), draft_.locals.begin() + at.local);
        std::copy(block_.words.begin(), block_.words.end(), packed_.cells.begin() + at.word);
        const CellOrigin* origin = origins_.data();
        for (const BlockClusters::Cluster& cluster : block_.clusters) {
            ClusterHeader& header = packed_.headers[at.cluster];
            header = header_of(cluster);
            header.first_word = at.word;
            header.first_group = static_cast<std::uint32_t>(at.group);
            draft_.first_local[at.cluster] = at.local;
            if (!origins_.empty()) origin = write_ids(header, origin);
            at.group += header.groups();
            at.word += header.words();
            at.local += cluster.points;
            ++at.cluster;
        }
    }

private:
    /// Each word of a cell has its id. Returns the origin of the next cluster's first cell.
    const CellOrigin* write_ids(const ClusterHeader& header, const CellOrigin* origin) {
        std::uint64_t word = header.first_word;
        for (const CellKind kind : cell_kinds)
            for (std::size_t i = 0; i < header.count(kind); ++i, ++origin)
                for (std::size_t k = 0; k < words_of(kind); ++k, ++word)
                    if (packed_.wide_cell_ids.empty())
                        packed_.cell_ids[word] = static_cast<std::uint32_t>(origin->cell());
                    else packed_.wide_cell_ids[word] = origin->cell();
        return origin;
    }

    const BlockClusters& block_;
    const std::span<const CellOrigin> origins_;
    Draft& draft_;
    Packed& packed_;
};

} // namespace

std::size_t blocks_at_once(std::uint64_t cells) {
    const std::size_t most = std::max<std::size_t>(4, blocks_for(cells) / 5);
    return std::min(static_cast<std::size_t>(threads_here()), most);
}

template <class Item>
Result<void> form_clusters(CellOrder<Item> order, std::uint64_t user_cells, Draft& draft, const Progress& progress) {
    const bool source_cells = order.cells.has_origins();
    const std::size_t count = order.cells.size();
    const std::size_t block_count = blocks_for(count);
    std::vector<BlockClusters> blocks(block_count);
    std::atomic<std::size_t> next_block{0}, finished{0};
    worker_each(blocks_at_once(count), 1, [&](std::size_t) {
        for (std::size_t b = next_block++; b < block_count; b = next_block++) {
            if (progress.cancelled()) return;
            try {
                blocks[b] = grow_block(order.cells, b * cells_per_block,
                                       std::min(cells_per_block, count - b * cells_per_block));
            } catch (...) {
                next_block = block_count; // no thread begins another one
                throw;
            }
            const auto done = static_cast<double>(++finished);
            if (!is_worker()) progress("pack", 0.3 + 0.3 * done / static_cast<double>(block_count));
        }
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "packing was cancelled"};
    order.cells.drop_items();

    std::vector<Start> starts(block_count + 1);
    for (std::size_t b = 0; b < block_count; ++b) {
        Start next = starts[b];
        const BlockClusters& block = blocks[b];
        next.cluster += block.clusters.size();
        next.local += block.points.size();
        next.word += block.words.size();
        for (const auto& cluster : block.clusters) next.group += header_of(cluster).groups();
        starts[b + 1] = next;
    }
    const Start total = starts[block_count];
    constexpr std::size_t limit = std::numeric_limits<std::uint32_t>::max();
    if (total.cluster >= limit || total.group >= limit)
        return Error{ErrorCode::invalid_data,
                     fmt::format("the grid makes {} clusters and {} groups of cells, but there can be {} of each",
                                 total.cluster, total.group, limit - 1)};

    Packed& packed = draft.packed;
    packed.headers = SharedBuffer<ClusterHeader>(total.cluster);
    packed.cells = SharedBuffer<StoredTet>(total.word + slack_words);
    std::fill(packed.cells.begin() + total.word, packed.cells.end(), StoredTet{});
    draft.first_local = Buffer<std::uint64_t>(total.cluster + 1);
    draft.locals = Buffer<std::uint64_t>(total.local);
    draft.first_local[total.cluster] = total.local;
    const bool wide_cells = user_cells > std::uint64_t{1} << 32;
    if (source_cells && wide_cells) packed.wide_cell_ids = SharedBuffer<std::uint64_t>(total.word);
    else if (source_cells) packed.cell_ids = SharedBuffer<std::uint32_t>(total.word);
    worker_each(block_count, 1, [&](std::size_t b) {
        const BlockClusters block = std::move(blocks[b]);
        std::vector<CellOrigin> origins;
        if (source_cells) {
            origins.resize(std::min(cells_per_block, count - b * cells_per_block));
            order.cells.copy_origins(b * cells_per_block, origins);
        }
        BlockWriter(block, origins, draft).write(starts[b]);
    });
    draft.point_of = std::move(order.point_of);
    PackReport& report = packed.report;
    report.clusters = total.cluster;
    report.tets = order.kinds[0];
    report.pyramids = order.kinds[1];
    report.wedges = order.kinds[2];
    report.hexahedra = order.kinds[3];
    report.repeated_tets = order.repeated;
    report.negative_tets = order.orientation.negative + order.orientation.twisted;
    report.inverted_tets = order.inverted;
    report.flat_tets = order.orientation.flat;
    return {};
}

template Result<void> form_clusters<RankedTet>(CellOrder<RankedTet>, std::uint64_t, Draft&, const Progress&);
template Result<void> form_clusters<RankedCell>(CellOrder<RankedCell>, std::uint64_t, Draft&, const Progress&);

} // namespace isotet::core
