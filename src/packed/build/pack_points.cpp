// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <limits>

#include "base/workers.hpp"
#include "packed/build/pack_draft.hpp"

namespace isotet::core {

namespace {

/// The lowest-numbered cluster that holds each point, by rank.
Buffer<std::uint32_t> find_owners(const Draft& draft) {
    Buffer<std::uint32_t> owners(draft.point_of.size());
    worker_ranges(owners.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        std::fill(owners.begin() + begin, owners.begin() + end, std::numeric_limits<std::uint32_t>::max());
    });
    worker_each(draft.clusters(), clusters_per_task, [&](std::size_t c) {
        for (std::size_t i = draft.first_local[c]; i < draft.first_local[c + 1]; ++i) {
            std::atomic_ref<std::uint32_t> owner(owners[draft.locals[i]]);
            std::uint32_t seen = owner.load(std::memory_order_relaxed);
            while (c < seen &&
                   !owner.compare_exchange_weak(seen, static_cast<std::uint32_t>(c), std::memory_order_relaxed)) {}
        }
    });
    return owners;
}

} // namespace

void number_points(std::uint64_t user_points, Draft& draft) {
    Packed& packed = draft.packed;
    const Buffer<std::uint32_t> owners = find_owners(draft);

    // Own points of a cluster ascend by rank.
    Buffer<std::uint8_t> place(owners.size());
    worker_each(draft.clusters(), clusters_per_task, [&](std::size_t c) {
        std::uint64_t own[max_cluster_points];
        std::size_t count = 0;
        for (std::size_t i = draft.first_local[c]; i < draft.first_local[c + 1]; ++i)
            if (owners[draft.locals[i]] == c) own[count++] = draft.locals[i];
        std::sort(own, own + count);
        for (std::size_t k = 0; k < count; ++k) place[own[k]] = static_cast<std::uint8_t>(k);
        packed.headers[c].own_points = static_cast<std::uint16_t>(count);
        packed.headers[c].ghost_points = static_cast<std::uint16_t>(draft.local_count(c) - count);
    });
    std::uint64_t points = 0;
    for (ClusterHeader& header : packed.headers) {
        header.first_point = points;
        points += header.own_points;
    }
    const bool wide = user_points > std::uint64_t{1} << 32;
    if (wide) packed.wide_point_ids = SharedBuffer<std::uint64_t>(points);
    else packed.point_ids = SharedBuffer<std::uint32_t>(points);

    // Local points in packed order, and the cells' corners with them.
    worker_each(draft.clusters(), clusters_per_task, [&](std::size_t c) {
        std::uint64_t ghost[max_cluster_points]; // by PointRef; the lowest byte is the place so far
        std::uint8_t after[max_cluster_points];
        std::size_t ghost_count = 0;
        const std::size_t count = draft.local_count(c);
        std::uint64_t* const list = draft.locals.data() + draft.first_local[c];
        ClusterHeader& header = packed.headers[c];
        for (std::size_t k = 0; k < count; ++k) {
            const std::uint64_t rank = list[k];
            const PointRef ref = PointRef::make(owners[rank], place[rank]);
            if (ref.owner() != c) {
                ghost[ghost_count++] = ref.value << 8 | k;
                continue;
            }
            after[k] = static_cast<std::uint8_t>(header.ghost_points + ref.index());
            const std::uint64_t point = header.first_point + ref.index(), user = draft.point_of[rank];
            if (wide) packed.wide_point_ids[point] = user;
            else packed.point_ids[point] = static_cast<std::uint32_t>(user);
        }
        std::sort(ghost, ghost + ghost_count);
        for (std::size_t k = 0; k < ghost_count; ++k) {
            after[ghost[k] & 0xff] = static_cast<std::uint8_t>(k);
            list[k] = ghost[k] >> 8;
        }
        for (std::size_t k = 0; k < header.own_points; ++k) // own ones last: no owner is a later cluster
            list[ghost_count + k] = PointRef::make(static_cast<std::uint32_t>(c), static_cast<std::uint8_t>(k)).value;
        StoredTet* const words = packed.cells.data() + header.first_word;
        for (std::size_t i = 0; i < header.words(); ++i)
            for (std::uint8_t& corner : words[i].corners) corner = after[corner];
    });
}

} // namespace isotet::core
