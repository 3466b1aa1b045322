// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cutting one cluster at one isovalue: what plain_cluster.cpp (fast, for most) and any_cluster.cpp (for all) have in common.
//
// A vertex of a cluster has a *key*: lower local index * 128 + higher for one on an edge, local index * 129 for one at a tied
// point. Keys are bits of a matrix while vertices are gathered, and places in a table once they have numbers.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/arithmetic.hpp"
#include "core/local_values.hpp"
#include "cpu/record.hpp"
#include "cpu/simd_portable.hpp"
#include "cpu/steps.hpp"

namespace isotet::cpu {

constexpr VertexKey edge_key(core::SeamEdge edge) { return static_cast<VertexKey>(edge.lower * core::max_cluster_points + edge.higher); }
constexpr VertexKey point_key(std::size_t local) { return static_cast<VertexKey>(local * (core::max_cluster_points + 1)); }

/// What all threads share while they count.
template <class Real>
struct Cutting {
    const Packed& packed;
    const Wanted<Real>& wanted;
    const Selection& selection;
    Masks& masks;
};

/// One thread's memory.
template <class Real>
struct CutScratch {
    static constexpr std::size_t points = core::max_cluster_points;
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

    std::size_t cluster = none, next_cluster = none;
    std::array<core::LocalPoints, 2> found;
    core::LocalPoints* local = &found[0]; ///< of `cluster`
    core::LocalPoints* next = &found[1];  ///< of `next_cluster`
    alignas(64) std::array<Real, points> values{}; ///< of `cluster`
    alignas(64) std::array<std::uint8_t, points> above{}; ///< 1 or 0
    std::array<std::uint8_t, points> special;             ///< tied or without data; for any_cluster.cpp
    CutTets cut;
    std::array<VertexKey, 4 * core::max_cluster_tets> keys;  ///< of the polygons of cut tets, four each
    std::array<std::uint64_t, points * points / 64> used{}; ///< bits of keys; all 0 between places
    std::array<std::uint64_t, points * points / 128> crossed_seams;
    std::vector<VertexKey> listed;
    std::vector<SharedVertex> shared;
    std::vector<VertexKey> shared_keys;
    std::array<std::uint16_t, points * points> numbers; ///< local, by key; only where one was written
    Arena arena;
    std::size_t record_bytes = 0; ///< of all records made

    void use(VertexKey key) { used[key / 64] |= std::uint64_t{1} << key % 64; }
    bool is_used(VertexKey key) const { return used[key / 64] >> key % 64 & 1; }
    void take_out(VertexKey key) { used[key / 64] &= ~(std::uint64_t{1} << key % 64); }
    void share(VertexKey key, SharedVertex vertex) {
        take_out(key);
        shared.push_back(vertex);
        shared_keys.push_back(key);
    }
};

inline void number_vertices(auto& s) {
    std::uint16_t number = 0;
    for (const VertexKey key : s.listed) s.numbers[key] = number++;
    for (const VertexKey key : s.shared_keys) s.numbers[key] = number++;
}

/// A record with everything but its triangles.
template <class Real>
Record<Real>& begin_record(Real isovalue, std::size_t triangles, bool has_tets, CutScratch<Real>& s) {
    using Made = Record<Real>;
    Made& record = *new (s.arena.take(Made::bytes(s.listed.size(), s.shared.size(), triangles, has_tets))) Made;
    record.listed = static_cast<std::uint16_t>(s.listed.size());
    record.shared = static_cast<std::uint16_t>(s.shared.size());
    record.triangles = static_cast<std::uint16_t>(triangles);
    record.has_tets = has_tets;
    Real* const weights = record.weights();
    EndPair* const ends = record.ends();
    for (std::size_t i = 0; i < s.listed.size(); ++i) {
        const std::size_t lower = s.listed[i] / CutScratch<Real>::points, higher = s.listed[i] % CutScratch<Real>::points;
        const std::size_t below = s.above[lower] ? higher : lower, above = lower ^ higher ^ below;
        weights[i] = core::edge_weight(isovalue, s.values[below], s.values[above]);
        ends[i] = {static_cast<std::uint8_t>(below), static_cast<std::uint8_t>(above)};
    }
    std::copy(s.shared.begin(), s.shared.end(), record.shared_vertices());
    return record;
}

/// Counts a place and leaves a record of it; null when its cluster is not plain: nothing has been changed then.
const Record<float>* cut_plain_cluster(const Cutting<float>& cutting, std::size_t place, CutScratch<float>& scratch, Start& count);

/// Counts a place of any cluster. `tied_points` grows by the points of its own that are tied.
template <class Real>
const Record<Real>* cut_any_cluster(const Cutting<Real>& cutting, std::size_t place, CutScratch<Real>& scratch, Start& count,
                                    std::uint64_t& tied_points);

} // namespace isotet::cpu
