// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed/build/bucket_sorter.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>

#include "grid/cell/native_cells.hpp"

namespace isotet::core {

namespace {

/// What a bucket has by lowest rank, then as it was dealt out. What has the rank k is [first[k], first[k + 1]).
template <class Item>
struct ByRank {
    std::vector<std::uint32_t> first;
    Buffer<Item> items;
    Buffer<CellOrigin> origins;
};

template <class Item>
ByRank<Item> by_rank(const RankedBuckets<Item>& all, std::size_t bucket) {
    const std::size_t ranks = all.ranks_per_bucket();
    const std::size_t size = all.dealt(bucket);
    ByRank<Item> out{std::vector<std::uint32_t>(ranks + 1, 0), Buffer<Item>(size), {}};
    if (all.has_origins()) out.origins = Buffer<CellOrigin>(size);
    const auto rank_in_bucket = [&](const Item& item) { return lowest_rank(item) % ranks; };
    all.for_dealt(bucket, [&](const Item& item, CellOrigin) { ++out.first[rank_in_bucket(item)]; });
    std::uint32_t sum = 0;
    for (std::uint32_t& count : out.first) sum += std::exchange(count, sum);
    all.for_dealt(bucket, [&](const Item& item, CellOrigin origin) {
        const std::uint32_t at = out.first[rank_in_bucket(item)]++;
        out.items[at] = item;
        if (all.has_origins()) out.origins[at] = origin;
    });
    std::copy_backward(out.first.begin(), out.first.end() - 1,
                       out.first.end()); // each has moved on to where the next began
    out.first[0] = 0;
    return out;
}

template <std::size_t n>
std::array<std::uint32_t, n> ascending(std::array<std::uint32_t, n> corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
}
/// The edges of a cell: cells of other kinds than tets may have the same corners and yet be different.
auto ascending(const RankedCell& cell) {
    std::array<std::uint64_t, 12> edges;
    edges.fill(std::numeric_limits<std::uint64_t>::max());
    std::size_t count = 0;
    for (const auto& [k, l] : edges_of(cell.kind())) {
        const std::uint64_t a = cell.corners[k], b = cell.corners[l];
        edges[count++] = std::min(a, b) << 32 | std::max(a, b);
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

template <std::size_t n>
std::uint32_t sum_of_ranks(const std::array<std::uint32_t, n>& corners) {
    std::uint32_t sum = 0;
    for (const std::uint32_t corner : corners) sum += corner;
    return sum;
}
std::uint32_t sum_of_ranks(const RankedCell& cell) { return sum_of_ranks(cell.corners); }

/// False when no two items have the same corners, and nearly always then.
template <class Item>
bool may_repeat(std::span<const Item> items) {
    std::array<std::uint64_t, 8> seen{}; // a bit for each of 512 hash values
    std::uint64_t again = 0;
    for (const Item& item : items) {
        const std::uint32_t hash = sum_of_ranks(item) * 0x9e3779b9u >> 23;
        const std::uint64_t bit = std::uint64_t{1} << hash % 64;
        again |= seen[hash / 64] & bit;
        seen[hash / 64] |= bit;
    }
    return again != 0;
}

/// Marks each item that has the corners, and so the edges, of an earlier one.
template <class Item>
void mark_repeated(std::span<const Item> items, std::vector<std::uint8_t>& repeated) {
    std::vector<std::pair<decltype(ascending(items[0])), std::size_t>> sorted(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) sorted[i] = {ascending(items[i]), i};
    std::sort(sorted.begin(), sorted.end());
    for (std::size_t i = 1; i < sorted.size(); ++i)
        if (sorted[i].first == sorted[i - 1].first) repeated[sorted[i].second] = 1;
}

/// A tet with its corners in ascending order of the user's points, the order that makes all that follows simple: the
/// canonical form is this one, the last two exchanged where it is not upright.
struct Ascending {
    RankedTet ranks;
    bool odd; ///< whether the corners had the other orientation before

    Ascending(const RankedTet& tet, const std::uint64_t* user_points) {
        // The place of a corner is the number of lower ones. Branch-free: the order is unpredictable.
        std::array<std::uint64_t, 4> users;
        for (std::size_t k = 0; k < 4; ++k) users[k] = user_points[tet[k]];
        std::array<std::uint32_t, 4> places{};
        odd = false;
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = a + 1; b < 4; ++b) {
                const bool exchanged = users[b] < users[a];
                odd ^= exchanged;
                places[a] += exchanged;
                places[b] += !exchanged;
            }
        for (std::size_t k = 0; k < 4; ++k) ranks[places[k]] = tet[k];
    }
    RankedTet stored(bool exchange) const {
        return {ranks[0], ranks[1], ranks[exchange ? 3 : 2], ranks[exchange ? 2 : 3]};
    }
};

/// Gives items their stored form, and counts how they are turned.
class Turner {
public:
    Turner(const RankedPoints& points, const CellReader& cells, SortedBucket& out)
        : points_(points), cells_(cells), out_(out) {}

    /// False when the item does not stay. `place` is where it will stand.
    bool turn(RankedTet& ranks, CellOrigin origin, bool is_repeated, std::size_t place) {
        const Ascending tet(ranks, points_.user);
        const bool whole = cells_.only_tets() || Orienter::is_whole(cells_.type(origin.cell()));
        const auto& [a, b, c, d] = tet.ranks;
        const PointReader& at = points_.coordinates;
        const int sign =
            orientation_sign(at[a], at[b], at[c], at[d]) * (tet.odd ? -1 : 1); // of the tet as the user gave it
        if (whole) out_.balance += sign;
        if (is_repeated) return false;
        if (whole && sign == 0) out_.flat.push_back(place);
        bool mirrored = false;
        if (origin.is_ordered()) out_.orientation.add_ordered(sign);
        else mirrored = out_.orientation.add(sign, whole, origin.cell_negative());
        ranks = tet.stored(mirrored != tet.odd);
        ++out_.kinds[0];
        return true;
    }

    bool turn(RankedCell& cell, CellOrigin origin, bool is_repeated, std::size_t place) {
        const CellKind kind = cell.kind();
        if (kind == CellKind::tetrahedron) {
            RankedTet tet{cell.corners[0], cell.corners[1], cell.corners[2], cell.corners[3]};
            const bool stays = turn(tet, origin, is_repeated, place);
            std::copy(tet.begin(), tet.end(), cell.corners.begin());
            return stays;
        }
        if (is_repeated) return false;
        WholeCell user{kind, {}};
        for (std::size_t k = 0; k < corner_count(kind); ++k) user.corners[k] = points_.user[cell.corners[k]];
        const TurnOfCell turned =
            turn_of(user, [&](std::size_t corner) { return points_.coordinates[cell.corners[corner]]; });
        out_.orientation.twisted += turned.is_twisted();
        out_.orientation.flat += turned.is_flat();
        if (turned.is_mirrored() && !origin.is_ordered()) cell.corners = mirrored(kind, cell.corners);
        ++out_.kinds[static_cast<std::size_t>(kind)];
        return true;
    }

private:
    const RankedPoints& points_;
    const CellReader& cells_;
    SortedBucket& out_;
};

} // namespace

template <class Item>
SortedBucket sort_bucket(const RankedPoints& points, const CellReader& cells, std::size_t bucket,
                         RankedBuckets<Item>& all) {
    ByRank<Item> sorted = by_rank(all, bucket);
    SortedBucket out;
    Turner turner(points, cells, out);
    std::size_t kept = 0;
    std::vector<std::uint8_t> repeated;
    for (std::size_t rank = 0; rank + 1 < sorted.first.size(); ++rank) {
        const std::size_t begin = sorted.first[rank], end = sorted.first[rank + 1];
        const std::span<const Item> items(sorted.items.data() + begin, end - begin);
        repeated.assign(items.size(), 0);
        if (may_repeat(items)) mark_repeated(items, repeated);
        for (std::size_t i = begin; i < end; ++i) {
            const CellOrigin origin = all.has_origins() ? sorted.origins[i] : CellOrigin{};
            if (!turner.turn(sorted.items[i], origin, repeated[i - begin], kept)) {
                ++out.repeated;
                continue;
            }
            sorted.items[kept] = sorted.items[i];
            if (all.has_origins()) sorted.origins[kept] = origin;
            ++kept;
        }
    }
    all.write_sorted(bucket, {sorted.items.data(), kept}, {sorted.origins.data(), all.has_origins() ? kept : 0});
    return out;
}

template SortedBucket sort_bucket<RankedTet>(const RankedPoints&, const CellReader&, std::size_t,
                                             RankedBuckets<RankedTet>&);
template SortedBucket sort_bucket<RankedCell>(const RankedPoints&, const CellReader&, std::size_t,
                                              RankedBuckets<RankedCell>&);

} // namespace isotet::core
