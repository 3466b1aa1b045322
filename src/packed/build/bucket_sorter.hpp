// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The cells of one bucket: sorted, repeated ones dropped, the others turned upright.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "grid/cells.hpp"
#include "grid/orientation.hpp"
#include "packed/build/ranked_buckets.hpp"

namespace isotet::core {

/// What sorting a bucket finds out.
struct SortedBucket {
    Orienter::Counts orientation; ///< of what stays
    std::int64_t balance = 0;     ///< upright minus negative tetrahedra, repeated ones too
    std::uint64_t repeated = 0;
    std::array<std::uint64_t, cell_kind_count> kinds{}; ///< of what stays
    std::vector<std::size_t> flat; ///< which tets are flat tetrahedra: turned as most are, once that is known
};

/// Points by rank.
struct RankedPoints {
    const std::uint64_t* user; ///< their numbers in the user's grid
    PointReader coordinates;
};

/// Gives the items of a bucket their stored form and order: by lowest rank, then as they were dealt out. Of those with
/// the same corners the first stays.
///
/// Threads   buckets may be sorted at the same time
template <class Item>
SortedBucket sort_bucket(const RankedPoints& points, const CellReader& cells, std::size_t bucket,
                         RankedBuckets<Item>& items);

} // namespace isotet::core
