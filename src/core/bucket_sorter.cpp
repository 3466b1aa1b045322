// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/bucket_sorter.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace isotet::core {

namespace {

/// The tets of a bucket by lowest rank, then as they were dealt out. Those of the rank k are [first[k], first[k + 1]).
struct ByRank {
    std::vector<std::uint32_t> first;
    Buffer<RankedTet> tets;
    Buffer<TetOrigin> origins;
};

ByRank by_rank(const TetBuckets& all, std::size_t bucket) {
    const std::size_t ranks = all.ranks_per_bucket();
    const std::size_t size = all.dealt(bucket);
    ByRank out{std::vector<std::uint32_t>(ranks + 1, 0), Buffer<RankedTet>(size), {}};
    if (all.has_origins()) out.origins = Buffer<TetOrigin>(size);
    const auto rank_in_bucket = [&](const RankedTet& tet) { return lowest_rank(tet) % ranks; };
    all.for_dealt(bucket, [&](const RankedTet& tet, TetOrigin) { ++out.first[rank_in_bucket(tet)]; });
    std::uint32_t sum = 0;
    for (std::uint32_t& count : out.first) sum += std::exchange(count, sum);
    all.for_dealt(bucket, [&](const RankedTet& tet, TetOrigin origin) {
        const std::uint32_t at = out.first[rank_in_bucket(tet)]++;
        out.tets[at] = tet;
        if (all.has_origins()) out.origins[at] = origin;
    });
    std::copy_backward(out.first.begin(), out.first.end() - 1,
                       out.first.end()); // each has moved on to where the next began
    out.first[0] = 0;
    return out;
}

RankedTet ascending(RankedTet tet) {
    std::sort(tet.begin(), tet.end());
    return tet;
}

std::uint32_t sum_of_ranks(const RankedTet& tet) { return tet[0] + tet[1] + tet[2] + tet[3]; }

/// False when no two tets have the same corners, and nearly always then.
bool may_repeat(std::span<const RankedTet> tets) {
    std::array<std::uint64_t, 8> seen{}; // a bit for each of 512 hash values
    std::uint64_t again = 0;
    for (const RankedTet& tet : tets) {
        const std::uint32_t hash = sum_of_ranks(tet) * 0x9e3779b9u >> 23;
        const std::uint64_t bit = std::uint64_t{1} << hash % 64;
        again |= seen[hash / 64] & bit;
        seen[hash / 64] |= bit;
    }
    return again != 0;
}

/// Marks each tet that has the corners of an earlier one.
void mark_repeated(std::span<const RankedTet> tets, std::vector<std::uint8_t>& repeated) {
    std::vector<std::pair<RankedTet, std::size_t>> sorted(tets.size());
    for (std::size_t i = 0; i < tets.size(); ++i) sorted[i] = {ascending(tets[i]), i};
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
        // Each corner stands behind those that are lower. Without branches: on what they depend nobody can predict.
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

} // namespace

SortedBucket sort_bucket(const RankedPoints& points, const CellReader& cells, std::size_t bucket, TetBuckets& all) {
    ByRank sorted = by_rank(all, bucket);
    SortedBucket out;
    std::size_t kept = 0;
    std::vector<std::uint8_t> repeated;
    for (std::size_t rank = 0; rank + 1 < sorted.first.size(); ++rank) {
        const std::size_t begin = sorted.first[rank], end = sorted.first[rank + 1];
        const std::span<const RankedTet> tets(sorted.tets.data() + begin, end - begin);
        repeated.assign(tets.size(), 0);
        if (may_repeat(tets)) mark_repeated(tets, repeated);
        for (std::size_t i = begin; i < end; ++i) {
            const Ascending tet(sorted.tets[i], points.user);
            const TetOrigin origin = all.has_origins() ? sorted.origins[i] : TetOrigin{};
            const bool whole = cells.only_tets() || Orienter::is_whole(cells.type(origin.cell()));
            const auto& [a, b, c, d] = tet.ranks;
            const PointReader& at = points.coordinates;
            const int sign =
                orientation_sign(at[a], at[b], at[c], at[d]) * (tet.odd ? -1 : 1); // of the tet as the user gave it
            if (whole) out.balance += sign;
            if (repeated[i - begin]) {
                ++out.repeated;
                continue;
            }
            if (whole && sign == 0) out.flat.push_back(kept);
            const bool mirrored = out.orientation.add(sign, whole, origin.cell_negative());
            sorted.tets[kept] = tet.stored(mirrored != tet.odd);
            if (all.has_origins()) sorted.origins[kept] = origin;
            ++kept;
        }
    }
    all.write_sorted(bucket, {sorted.tets.data(), kept}, {sorted.origins.data(), all.has_origins() ? kept : 0});
    return out;
}

} // namespace isotet::core
