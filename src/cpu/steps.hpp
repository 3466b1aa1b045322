// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The four steps of extraction on the CPU and what they hand on: select, count, scan, emit. N selected clusters.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/bits.hpp"
#include "core/buffer.hpp"
#include "core/packed.hpp"
#include "cpu/record.hpp"
#include "ops/extraction.hpp"

namespace isotet::cpu {

using core::Packed;
using ops::Request;

/// Clusters whose range holds the isovalue, both ends included, ascending.
struct Selection {
    core::Buffer<std::uint32_t> clusters;
    core::Buffer<std::uint32_t> place; ///< C: cluster -> position in `clusters`; only set for those
};

/// Which of its own points (tied ones) and own seam edges a cluster gives vertices to. Bits are set by every cluster that
/// holds them, with atomic ORs: these commute, so threads do not matter.
class Masks {
public:
    static constexpr std::size_t tied_words = core::words_of_bits(core::max_cluster_points);

    Masks() = default;
    Masks(const Packed& packed, const Selection& selection);

    std::uint64_t* tied(std::size_t place) { return words_.data() + first_word_[place]; }
    const std::uint64_t* tied(std::size_t place) const { return words_.data() + first_word_[place]; }
    std::uint64_t* seams(std::size_t place) { return tied(place) + tied_words; }
    const std::uint64_t* seams(std::size_t place) const { return tied(place) + tied_words; }
    std::size_t seam_words(std::size_t place) const { return first_word_[place + 1] - first_word_[place] - tied_words; }
    std::size_t bytes() const { return first_word_.bytes() + words_.bytes(); }

private:
    core::Buffer<std::uint64_t> first_word_; ///< N + 1
    core::Buffer<std::uint64_t> words_;
};

/// What one selected cluster gives by itself.
struct Count {
    std::uint32_t inner_edges;
    std::uint32_t triangles;
};

/// What counting hands to scan and emit.
struct Counted {
    core::Buffer<Count> counts;           ///< N
    core::Buffer<const Record*> records;  ///< N; null where the cluster is not plain: emit then looks at its tets again
    std::vector<std::shared_ptr<const void>> memory; ///< keeps the records
    std::size_t record_bytes = 0;
    std::uint64_t tied_points = 0;
};

/// The numbers of the first vertex and triangle of each selected cluster.
struct Start {
    std::uint64_t vertex;
    std::uint64_t triangle;
};

template <class Real>
Selection select(const Packed& packed, Real isovalue);

template <class Real>
Counted count(const Packed& packed, const Request<Real>& request, const Selection& selection, Masks& masks, const Progress& progress);

/// N + 1 starts; the last one holds the totals.
core::Buffer<Start> scan(const core::Buffer<Count>& counts, const Masks& masks);

/// Where the parts of a surface are written; null where not wanted.
template <class Real>
struct Target {
    Real* positions = nullptr;
    float* normals = nullptr;
    std::int64_t* ends = nullptr;
    Real* weights = nullptr;
    std::int64_t* source_cells = nullptr;
};

template <class Real, class Index>
void emit(const Packed& packed, const Request<Real>& request, const Selection& selection, const Masks& masks,
          const Counted& counted, const core::Buffer<Start>& starts, const Target<Real>& target, Index* triangles, const Progress& progress);

} // namespace isotet::cpu
