// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cutting one cluster at one isovalue: what plain_cluster.cpp (fast, for most) and any_cluster.cpp (for all) have in
// common.
//
// A vertex of a cluster has a *key*: lower local index * 128 + higher for one on an edge, local index * 129 for one at
// a tied point. Keys are marked in a table while vertices are gathered, and are places in another once they have
// numbers.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "cpu/prefetch.hpp"
#include "cpu/record.hpp"
#include "cpu/simd_portable.hpp"
#include "cpu/steps.hpp"
#include "numbers/arithmetic.hpp"
#include "packed/local_values.hpp"

namespace isotet::cpu {

constexpr VertexKey point_key(std::size_t local) {
    return static_cast<VertexKey>(local * (core::max_cluster_points + 1));
}

/// A list with room for `most`: adding to it checks nothing.
template <class T, std::size_t most>
class ShortList {
public:
    void clear() { size_ = 0; }
    void push_back(const T& element) { elements_[size_++] = element; }
    T* end() { return elements_.data() + size_; } ///< more may be written there, and then
    void grow(std::size_t n) { size_ += n; }      ///< counted
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const T* data() const { return elements_.data(); }
    const T* begin() const { return data(); }
    const T* end() const { return data() + size_; }

private:
    std::array<T, most> elements_;
    std::size_t size_ = 0;
};

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
    static constexpr std::size_t padded = max_vertices + 128; ///< SIMD code writes more than it counts
    static constexpr std::size_t ghost_words = CrossedBefore::most / 64 + 1;
    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

    std::size_t cluster = none, next_cluster = none;
    std::array<core::LocalPoints, 2> found;
    core::LocalPoints* local = &found[0];                 ///< of `cluster`
    core::LocalPoints* next = &found[1];                  ///< of `next_cluster`
    alignas(64) std::array<Real, points> values{};        ///< of `cluster`
    alignas(64) std::array<std::uint8_t, points> above{}; ///< 1 or 0
    std::array<std::uint8_t, points> special;             ///< tied or without data; for any_cluster.cpp
    CutTets cut;
    CutCells cells;
    std::array<VertexKey, 4 * CutTets::room> keys;  ///< of the polygons of active cells, four each
    KeyTable used;                                  ///< empty between places
    std::array<VertexKey, padded> ghost_keys;       ///< of ghost seams that are crossed; for any_cluster.cpp
    std::array<std::uint64_t, ghost_words> crossed; ///< a bit for each ghost seam
    ShortList<VertexKey, padded> listed;
    std::array<EndPair, padded> ends; ///< of listed vertices
    std::array<Real, padded> weights;
    std::array<EndPositions<Real>, padded> end_positions; ///< of the vertices of `unplaced`
    const Record<Real>* unplaced = nullptr;               ///< whose positions are still to be written
    ShortList<SharedVertex, padded> shared;
    ShortList<VertexKey, padded> shared_keys;
    std::array<std::uint16_t, points * points> numbers; ///< see with_numbers()
    Arena arena;
    std::size_t record_bytes = 0; ///< of all records made

    void share(VertexKey key, SharedVertex vertex) {
        used.take_out(key);
        shared.push_back(vertex);
        shared_keys.push_back(key);
    }
};

/// Asks for what the clusters after the next one will read. Called in the middle of a cluster's work: at its beginning the
/// values of the next one are asked for, and only some dozens of requests can be under way.
template <class Real>
void ask_further_ahead(const Cutting<Real>& cutting, std::size_t place) {
    const Packed& packed = cutting.packed;
    const PlacesAhead ahead(cutting.selection, place);
    const auto cluster = [&](std::size_t i) { return cutting.selection.clusters[ahead[i]]; };
    if (ahead.has(2)) prefetch(&packed.headers[cluster(2)]);
    if (ahead.has(1)) {
        const core::ClusterHeader& h = packed.headers[cluster(1)];
        prefetch_bytes(packed.links.data() + h.first_link, 4 * core::ClusterLinks::words(h));
        prefetch_bytes(packed.cells.data() + h.first_word, sizeof(core::StoredTet) * h.words());
        prefetch_bytes(packed.as<Real>().values.data() + h.first_point, sizeof(Real) * h.own_points);
        prefetch(packed.group_ranges.data() + h.first_group);
    }
}

/// Calls f(numbers, corners) with a table of local vertex numbers by key, and where the record has such numbers for the
/// corners of triangles: bytes where they suffice, which are nearer in the cache.
template <class Real, class F>
void with_numbers(CutScratch<Real>& s, const Record<Real>& record, F&& f) {
    const auto call = [&](auto* numbers) {
        using Number = std::remove_pointer_t<decltype(numbers)>;
        std::size_t number = 0;
        for (const VertexKey key : s.listed) numbers[key] = static_cast<Number>(number++);
        for (const VertexKey key : s.shared_keys) numbers[key] = static_cast<Number>(number++);
        f(static_cast<const Number*>(numbers), static_cast<Number*>(record.corners()));
    };
    if (record.wide()) call(s.numbers.data());
    else call(reinterpret_cast<std::uint8_t*>(s.numbers.data()));
}

/// A record that holds what was shared; its triangles and listed vertices are yet to come.
template <class Real>
Record<Real>& begin_record(const Wanted<Real>& wanted, std::size_t triangles, CutScratch<Real>& s) {
    using Made = Record<Real>;
    // Positions are what emit will want; but triangles that share few vertices have too many of them to keep.
    const std::size_t kept = 12 * s.listed.size() + sizeof(SharedVertex) * s.shared.size();
    const bool has_ends = wanted.ends || kept > 24 * triangles;
    const std::size_t bytes = Made::bytes(s.listed.size(), s.shared.size(), triangles, has_ends, wanted.source_cells);
    Made& record = *new (s.arena.take(bytes)) Made;
    record.listed = static_cast<std::uint16_t>(s.listed.size());
    record.shared = static_cast<std::uint16_t>(s.shared.size());
    record.triangles = static_cast<std::uint16_t>(triangles);
    record.has_ends = has_ends;
    record.has_tets = wanted.source_cells;
    std::copy_n(s.shared.data(), s.shared.size(), record.shared_vertices());
    return record;
}

/// Writes the positions that keep_vertices() left, before scratch.weights are written again.
template <class Simd, class Real>
void place_vertices(CutScratch<Real>& s) {
    if (!s.unplaced) return;
    Simd::place(s.end_positions.data(), s.weights.data(), s.unplaced->listed, s.unplaced->positions());
    s.unplaced = nullptr;
}

/// Listed vertices, from scratch.ends and scratch.weights. Positions of their ends are only asked for: place_vertices(), a
/// cluster later, finds them there.
template <class Real>
void keep_vertices(const Packed& packed, CutScratch<Real>& s, const Record<Real>& record) {
    if (record.has_ends) {
        std::copy_n(s.ends.data(), record.listed, record.ends());
        std::copy_n(s.weights.data(), record.listed, record.weights());
        return;
    }
    const Real* const positions = packed.as<Real>().positions.data();
    for (std::size_t i = 0; i < record.listed; ++i) {
        s.end_positions[i] = {positions + 3 * (*s.local)[s.ends[i].below], positions + 3 * (*s.local)[s.ends[i].above]};
        prefetch(s.end_positions[i].below);
        prefetch(s.end_positions[i].above);
    }
    s.unplaced = &record;
}

/// Counts a place and leaves a record of it; null when its cluster is not plain: nothing has been changed then.
const Record<float>* cut_plain_cluster(const Cutting<float>& cutting, std::size_t place, CutScratch<float>& scratch,
                                       Start& count);

/// Counts a place of any cluster. `tied_points` grows by the points of its own that are tied.
template <class Real>
const Record<Real>* cut_any_cluster(const Cutting<Real>& cutting, std::size_t place, CutScratch<Real>& scratch,
                                    Start& count, std::uint64_t& tied_points);

} // namespace isotet::cpu
