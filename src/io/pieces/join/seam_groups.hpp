// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Settles which of some points that lie close together are one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "io/pieces/join/seams.hpp"

namespace isotet::io {

struct SeamPoint {
    std::uint64_t point;
    std::uint32_t piece;
    std::uint64_t id;
    std::array<double, 3> place;
    std::array<double, 3> scaled; ///< with the tolerance as the unit
};

struct SeamGroup {
    std::vector<SeamPoint> points; ///< ascending by `point`, so those of a piece one after another
};

enum class DecideBy : std::uint8_t { places, ids };

/// Adds what is joined to `seams`, and what is left apart though it is close. May reorder the group.
///
/// Cost   O(k^2) of k points up to 128, O(k log k) of more
void settle_group(SeamGroup& group, DecideBy by, Seams& seams);

} // namespace isotet::io
