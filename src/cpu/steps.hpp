// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The four steps of extraction on the CPU and what they hand on: select, count, scan, emit. All isovalues of a call go
// through them together. A cluster and an isovalue inside its range have a *place*: N places, by cluster, then by
// isovalue.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "base/bits.hpp"
#include "base/buffer.hpp"
#include "cpu/record.hpp"
#include "ops/extraction.hpp"
#include "packed/packed.hpp"

namespace isotet::cpu {

using core::Packed;

/// What is extracted: as ops::Request, but the isovalues ascend.
template <class Real>
struct Wanted {
    std::span<const core::StoredIsovalue<Real>> isovalues;
    Ties ties = Ties::merge;
    bool ends = false; ///< records keep ends and weights of vertices instead of positions
    bool source_cells = false;
    std::span<const ops::CarriedField> fields{};
};

/// The places: pairs of a cluster and an isovalue inside its range, both ends included.
struct Selection {
    core::Buffer<std::uint32_t> clusters;   ///< N
    core::Buffer<std::uint32_t> isovalues;  ///< N: numbers of isovalues
    core::Buffer<std::uint64_t> first_word; ///< N + 1: where the masks of a place begin
    core::Buffer<std::uint32_t> base;       ///< C: only set for clusters with a place
    std::uint64_t tets = 0;                 ///< of the clusters of all places; ClusterHeader::like_tets()
    std::size_t ahead_end = 0; ///< places from here on are not looked at ahead: their clusters may not be in memory

    std::size_t size() const { return clusters.size(); }
    /// The place of a cluster and an isovalue that has one: those of a cluster stand side by side.
    std::size_t place(std::uint32_t cluster, std::uint32_t isovalue) const {
        return base[cluster] + isovalue; // modulo 2^32
    }
    std::size_t bytes() const { return clusters.bytes() + isovalues.bytes() + first_word.bytes() + base.bytes(); }
};

/// Which of its own points (tied ones) and own seam edges a cluster gives vertices to. Bits are set by every cluster
/// that holds them, with atomic ORs: these commute, so threads do not matter.
class Masks {
public:
    static constexpr std::size_t tied_words = core::words_of_bits(core::max_cluster_points);

    explicit Masks(const Selection& selection);

    std::uint64_t* tied(std::size_t place) { return words_.data() + selection_->first_word[place]; }
    const std::uint64_t* tied(std::size_t place) const { return words_.data() + selection_->first_word[place]; }
    std::uint64_t* seams(std::size_t place) { return tied(place) + tied_words; }
    const std::uint64_t* seams(std::size_t place) const { return tied(place) + tied_words; }
    std::size_t seam_words(std::size_t place) const { return words(place) - tied_words; }
    /// Bits that other threads may be setting, too.
    void set_tied(std::size_t place, std::size_t own_point) { set(tied(place), own_point); }
    void set_seam(std::size_t place, std::size_t seam) { set(seams(place), seam); }
    void set_seams(std::size_t place, std::size_t word, std::uint64_t bits) {
        if (bits) std::atomic_ref<std::uint64_t>(seams(place)[word]).fetch_or(bits, std::memory_order_relaxed);
    }

    /// How many vertices the masks know.
    std::size_t vertices(std::size_t place) const { return core::count_bits(tied(place), words(place)); }
    /// The number of such a vertex among those of its owner.
    std::size_t rank(const SharedVertex& vertex) const {
        const std::uint64_t* const own_tied = tied(vertex.owner);
        if (vertex.index >= SharedVertex::tied) return core::rank_of_bit(own_tied, vertex.index - SharedVertex::tied);
        return core::count_bits(own_tied, tied_words) + core::rank_of_bit(own_tied + tied_words, vertex.index);
    }
    std::size_t bytes() const { return words_.bytes(); }

private:
    static void set(std::uint64_t* words, std::size_t i) {
        std::atomic_ref<std::uint64_t>(words[i / 64]).fetch_or(std::uint64_t{1} << i % 64, std::memory_order_relaxed);
    }
    std::size_t words(std::size_t place) const {
        return selection_->first_word[place + 1] - selection_->first_word[place];
    }

    const Selection* selection_;
    core::Buffer<std::uint64_t> words_;
};

/// Vertices and triangles: counts of a place, then the numbers of its first ones in the surface of its isovalue.
struct Start {
    std::uint64_t vertex = 0;
    std::uint64_t triangle = 0;
};

class Batches;

/// Whether counting leaves records behind.
enum class Keep { records, nothing };

/// What counting hands to scan and emit.
template <class Real>
struct Counted {
    core::Buffer<Start> starts;                      ///< N; of vertices those on inner edges
    core::Buffer<const Record<Real>*> records;       ///< N
    std::vector<std::uint64_t> tied_points;          ///< of each isovalue
    std::vector<std::shared_ptr<const void>> memory; ///< keeps the records
    std::size_t bytes = 0;                           ///< of all that
    std::size_t record_bytes = 0;                    ///< of records, kept or not
};

/// What there is of each isovalue in the end.
struct Total {
    std::uint64_t vertices = 0, triangles = 0, clusters = 0;
};

/// Where the parts of a surface are written; null where not wanted.
template <class Real>
struct Target {
    std::uint64_t vertices = 0; ///< how many there are
    Real* positions = nullptr;
    std::uint32_t* triangles = nullptr;
    std::uint64_t* wide_triangles = nullptr; ///< instead
    float* normals = nullptr;
    std::int64_t* ends = nullptr;
    Real* weights = nullptr;
    std::int64_t* source_cells = nullptr;
    std::vector<Real*> fields;
};

/// Errors   invalid_argument when there would be 2^32 places or more
template <class Real>
Result<Selection> select(const Packed& packed, std::span<const core::StoredIsovalue<Real>> isovalues);

/// Errors   of a grid that lies in a file, as Residency::bring()
template <class Real>
Result<Counted<Real>> count(const Packed& packed, const Wanted<Real>& wanted, const Selection& selection, Masks& masks,
                            Keep keep, Batches& batches, const Progress& progress);

/// Turns counts into starts. Returns the total of each isovalue.
std::vector<Total> scan(const Selection& selection, const Masks& masks, std::size_t isovalues,
                        core::Buffer<Start>& starts);

/// `targets`  one for each isovalue
/// Errors     as count()
template <class Real>
Result<void> emit(const Packed& packed, const Wanted<Real>& wanted, const Selection& selection, const Masks& masks,
                  const Counted<Real>& counted, std::span<const Target<Real>> targets, Batches& batches,
                  const Progress& progress);

/// Bytes of a thread while it counts, without records, and while it emits.
template <class Real>
std::size_t count_scratch_bytes();
template <class Real>
std::size_t emit_scratch_bytes();

} // namespace isotet::cpu
