// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The fast path: clusters of single precision where no local point is tied or without data. There a cluster knows by itself
// all of its vertices, so that one pass over its tets finds everything; all other clusters take cut_cluster.hpp, twice.
#pragma once

#include <array>
#include <cstdint>

#include "cpu/record.hpp"
#include "cpu/simd_portable.hpp"
#include "cpu/steps.hpp"

namespace isotet::cpu {

/// One thread's memory for the fast path.
struct PlainScratch {
    static constexpr std::size_t points = core::max_cluster_points;
    alignas(64) std::array<float, points> values{};
    alignas(64) std::array<std::uint8_t, points> above{};
    std::array<std::uint64_t, points> packed_points; ///< of local points
    std::array<std::uint64_t, points * points / 64> edges{}; ///< bit lower * 128 + higher: a crossed edge; all 0 between clusters
    std::array<std::uint16_t, points * points> numbers;      ///< of the vertex on an edge; only where it was written
    std::array<EdgeKey, 4 * core::max_cluster_tets> keys;
    std::array<std::uint64_t, points * points / 128> crossed_seams;
    std::vector<EdgeKey> own;                                ///< edges of own vertices, in order
    std::vector<ForeignVertex> foreign;
    std::vector<EdgeKey> foreign_keys;
    CutTets cut;
    Arena arena;
};

/// Counts a cluster and leaves a record of it. Null when it is not plain: nothing has been changed then.
const Record* cut_plain_cluster(const Packed& packed, const Request<float>& request, const Selection& selection, Masks& masks,
                                std::size_t place, PlainScratch& scratch, Count& count);

} // namespace isotet::cpu
