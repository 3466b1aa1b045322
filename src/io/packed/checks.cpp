// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/checks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "packed/local_values.hpp"

namespace isotet::io {

using core::ClusterHeader;
using core::ClusterLinks;
using core::Packed;

namespace {

Error broken_cluster(std::uint64_t cluster, const std::string& what) {
    return invalid_data(fmt::format("cluster {} is broken: {}", cluster, what));
}

std::size_t local_count(const ClusterHeader& h) { return std::size_t{h.ghost_points} + h.own_points; }

/// Counts alone, within what engines have room for.
Result<void> check_counts(std::uint64_t cluster, const ClusterHeader& h) {
    constexpr std::size_t most_seams = core::max_cluster_points * (core::max_cluster_points - 1) / 2;
    if (local_count(h) == 0 || local_count(h) > core::max_cluster_points)
        return broken_cluster(cluster, fmt::format("it has {} points, but there must be 1 to {}", local_count(h),
                                                   core::max_cluster_points));
    if (h.like_tets() == 0 || h.like_tets() > core::max_cluster_tets ||
        h.groups() > core::max_cluster_tets / core::group_size)
        return broken_cluster(cluster, fmt::format("it has {} tets and {} other cells, but there must be 1 to {} tets, and "
                                                   "other cells count {} times",
                                                   h.tets(), h.others(), core::max_cluster_tets, core::tets_for_a_cell));
    if (std::size_t{h.own_seams} + h.ghost_seams > most_seams || h.wide_seams > 1)
        return broken_cluster(cluster, fmt::format("it has {} seam edges, but there can be {}",
                                                   std::size_t{h.own_seams} + h.ghost_seams, most_seams));
    return {};
}

} // namespace

Result<void> decode_headers(std::span<const std::byte> records, const ChunkEntry& chunk, const ChunkPlaces& places,
                            std::size_t chunk_number, ClusterHeader* out) {
    std::array<std::uint64_t, unit_count> next{};
    for (std::size_t u = 0; u < unit_count; ++u) next[u] = places.first[u][chunk_number];
    auto& [point, word, link, group] = next;
    if (places.of(Unit::groups, chunk_number + 1) > std::numeric_limits<std::uint32_t>::max())
        return invalid_data("there are 2^32 groups of cells or more, which is not read");
    for (std::size_t i = 0; i < chunk.clusters; ++i) {
        std::array<std::uint16_t, cluster_record_bytes / 2> n;
        std::memcpy(n.data(), records.data() + cluster_record_bytes * i, cluster_record_bytes);
        ClusterHeader h{point, word, link, static_cast<std::uint32_t>(group), n[0], n[1], {n[2], n[3], n[4], n[5]},
                        n[6],  n[7], n[8], n[9]};
        if (auto ok = check_counts(places.first_cluster[chunk_number] + i, h); !ok) return ok;
        point += h.own_points;
        word += h.words();
        link += ClusterLinks::words(h);
        group += h.groups();
        out[i] = h;
    }
    for (std::size_t u = 0; u < unit_count; ++u)
        if (next[u] - places.first[u][chunk_number] != chunk.counts[u])
            return invalid_data(fmt::format("chunk {} is broken: the counts of its clusters add up to other sums", chunk_number));
    return {};
}

ChunkRange chunk_range(const PackedDirectory& directory, const ChunkPlaces& places, std::size_t chunk) {
    const ChunkEntry& entry = directory.chunks[chunk];
    return {places.first_cluster[chunk],     entry.clusters,
            places.of(Unit::points, chunk),  entry.count(Unit::points),
            places.of(Unit::words, chunk),   entry.count(Unit::words)};
}

namespace {

template <class Id>
bool all_ids_below(const core::SharedBuffer<Id>& ids, std::uint64_t first, std::uint64_t count, std::uint64_t end) {
    if (ids.empty()) return true;
    std::uint64_t largest = 0;
    for (std::uint64_t i = first; i < first + count; ++i) largest = std::max<std::uint64_t>(largest, ids[i]);
    return count == 0 || largest < end;
}

} // namespace

Result<void> check_points(const Packed& packed, const ChunkRange& chunk) {
    if (!all_ids_below(packed.point_ids, chunk.first_point, chunk.points, packed.user_points) ||
        !all_ids_below(packed.wide_point_ids, chunk.first_point, chunk.points, packed.user_points))
        return invalid_data(fmt::format("a point has a number that the user's grid of {} points has not",
                                        packed.user_points));
    return check_positions(packed, chunk);
}

Result<void> check_positions(const Packed& packed, const ChunkRange& chunk) {
    const bool finite = std::visit(
        [&](const auto& reals) {
            bool all = true;
            for (std::uint64_t i = 3 * chunk.first_point; i < 3 * (chunk.first_point + chunk.points); ++i)
                all &= std::abs(reals.positions[i]) <= largest_position;
            return all;
        },
        packed.reals);
    if (!finite) return invalid_data("a coordinate is not finite, or larger than is stored");
    return {};
}

namespace {

/// Pairs of local indices, each once.
class SeamSet {
public:
    bool add(core::SeamEdge edge) {
        std::uint64_t& word = words_[2 * edge.lower + edge.higher / 64];
        const std::uint64_t bit = std::uint64_t{1} << edge.higher % 64;
        const bool is_new = !(word & bit);
        word |= bit;
        return is_new;
    }

private:
    std::array<std::uint64_t, 2 * core::max_cluster_points> words_{};
};

Result<void> check_corners(const Packed& packed, std::uint32_t cluster) {
    const ClusterHeader& h = packed.headers[cluster];
    const auto* const corners = reinterpret_cast<const std::uint8_t*>(packed.cells.data() + h.first_word);
    std::uint8_t largest = 0;
    for (std::size_t i = 0; i < 4 * h.words(); ++i) largest = std::max(largest, corners[i]);
    if (largest >= local_count(h))
        return broken_cluster(cluster, fmt::format("a corner is local point {}, but it has {}", largest, local_count(h)));
    return {};
}

/// Of one neighbour: `points` and `seams` are the first of its part of the links.
Result<void> check_neighbour(const Packed& packed, std::uint32_t cluster, const ClusterLinks& links,
                             const core::Neighbour& neighbour, std::size_t points, std::size_t seams) {
    const ClusterHeader& h = packed.headers[cluster];
    if (neighbour.cluster >= cluster)
        return broken_cluster(cluster, fmt::format("its neighbour {} has no lower number", neighbour.cluster));
    if (points + neighbour.ghost_points > h.ghost_points || seams + neighbour.ghost_seams > h.ghost_seams)
        return broken_cluster(cluster, "its neighbours have more points or seam edges than it has");
    const ClusterHeader& owner = packed.headers[neighbour.cluster];
    for (std::size_t k = points; k < points + neighbour.ghost_points; ++k)
        if (links.ghost_points[k] >= owner.own_points)
            return broken_cluster(cluster, fmt::format("it borrows point {} of cluster {}, which has {}",
                                                       links.ghost_points[k], neighbour.cluster, owner.own_points));
    for (std::size_t k = seams; k < seams + neighbour.ghost_seams; ++k)
        if (links.seam_index(k) >= owner.own_seams)
            return broken_cluster(cluster, fmt::format("it names seam edge {} of cluster {}, which has {}",
                                                       links.seam_index(k), neighbour.cluster, owner.own_seams));
    return {};
}

Result<void> check_links(const Packed& packed, std::uint32_t cluster) {
    const ClusterHeader& h = packed.headers[cluster];
    const ClusterLinks links = packed.cluster_links(cluster);
    std::size_t points = 0, seams = 0;
    for (const core::Neighbour& neighbour : links.neighbours) {
        if (auto ok = check_neighbour(packed, cluster, links, neighbour, points, seams); !ok) return ok;
        points += neighbour.ghost_points;
        seams += neighbour.ghost_seams;
    }
    if (points != h.ghost_points || seams != h.ghost_seams)
        return broken_cluster(cluster, "its neighbours have fewer points or seam edges than it has");
    SeamSet seen;
    for (const auto& some : {links.own_seams, links.ghost_seams})
        for (const core::SeamEdge edge : some)
            if (edge.lower >= edge.higher || edge.higher >= local_count(h) || !seen.add(edge))
                return broken_cluster(cluster, fmt::format("its seam edge {}-{} is there twice, does not ascend, or has a "
                                                           "point that there is not",
                                                           edge.lower, edge.higher));
    return {};
}

} // namespace

Result<void> check_topology(const Packed& packed, const ChunkRange& chunk) {
    if (!all_ids_below(packed.cell_ids, chunk.first_word, chunk.words, packed.user_cells) ||
        !all_ids_below(packed.wide_cell_ids, chunk.first_word, chunk.words, packed.user_cells))
        return invalid_data(fmt::format("a cell has a number that the user's grid of {} cells has not",
                                        packed.user_cells));
    for (std::uint64_t c = chunk.first_cluster; c < chunk.first_cluster + chunk.clusters; ++c) {
        if (auto ok = check_corners(packed, static_cast<std::uint32_t>(c)); !ok) return ok;
        if (auto ok = check_links(packed, static_cast<std::uint32_t>(c)); !ok) return ok;
    }
    return {};
}

namespace {

template <class Real>
Result<void> check_values_of(const Packed& packed, const ChunkRange& chunk) {
    const auto& reals = packed.as<Real>();
    for (std::uint64_t c = chunk.first_cluster; c < chunk.first_cluster + chunk.clusters; ++c) {
        const ClusterHeader& h = packed.headers[c];
        const core::Range<Real> range = reals.ranges[c];
        bool fits = true, holes = false;
        for (std::uint64_t i = h.first_point; i < h.first_point + h.own_points; ++i) {
            const Real value = reals.values[i];
            const bool hole = core::is_nan(value);
            holes |= hole;
            fits &= hole || (range.lower <= value && value <= range.upper && std::abs(value) <= core::stored_infinity);
        }
        if (!fits) return broken_cluster(c, "a value lies outside of its range");
        if (holes && packed.has_no_data[c] == 0)
            return broken_cluster(c, "a point has no data, but the cluster is said to have none such");
    }
    return {};
}

template <class Real>
Result<void> check_ranges_of(const Packed& packed, std::uint32_t cluster) {
    const auto& reals = packed.as<Real>();
    std::array<Real, core::max_cluster_points> values;
    const std::size_t count = core::load_values(packed, cluster, values.data());
    core::Range<Real> range{std::numeric_limits<Real>::max(), std::numeric_limits<Real>::lowest()};
    bool holes = false;
    for (std::size_t k = 0; k < count; ++k) {
        holes |= core::is_nan(values[k]);
        range.lower = values[k] < range.lower ? values[k] : range.lower;
        range.upper = values[k] > range.upper ? values[k] : range.upper;
    }
    const core::Range<Real> said = reals.ranges[cluster];
    if (!(said.lower == range.lower && said.upper == range.upper) || holes != (packed.has_no_data[cluster] != 0))
        return broken_cluster(cluster, fmt::format("its values are {} to {}, but its range is {} to {}", range.lower,
                                                   range.upper, said.lower, said.upper));
    const ClusterLinks links = packed.cluster_links(cluster);
    std::size_t seam = 0;
    for (const core::Neighbour& neighbour : links.neighbours) {
        const core::Range<Real> owner = reals.ranges[neighbour.cluster];
        for (const std::size_t end = seam + neighbour.ghost_seams; seam < end; ++seam) {
            const core::SeamEdge edge = links.ghost_seams[seam];
            for (const Real value : {values[edge.lower], values[edge.higher]})
                if (!core::is_nan(value) && !(owner.lower <= value && value <= owner.upper))
                    return broken_cluster(cluster, fmt::format("a seam edge has a value outside of the range of its "
                                                               "owner, cluster {}",
                                                               neighbour.cluster));
        }
    }
    return {};
}

} // namespace

Result<void> check_values(const Packed& packed, const ChunkRange& chunk) {
    return packed.single() ? check_values_of<float>(packed, chunk) : check_values_of<double>(packed, chunk);
}

Result<void> check_ranges(const Packed& packed, std::uint32_t cluster) {
    return packed.single() ? check_ranges_of<float>(packed, cluster) : check_ranges_of<double>(packed, cluster);
}

} // namespace isotet::io
