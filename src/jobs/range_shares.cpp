// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/range_shares.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>

namespace isotet::jobs {

Result<SolidRange> with_shares(SolidRange range, const RangeShares& shares, const Grid& grid, const PointField& field,
                               const Run& run) {
    for (const auto& [share, end] : {std::pair(shares.lower, &range.lower), std::pair(shares.upper, &range.upper)}) {
        if (!share) continue;
        const auto found = isovalues_at(grid, field, {&*share, 1}, run);
        if (!found) return found.error();
        *end = found->front();
    }
    if (range.lower < range.upper) return range;
    return Error{ErrorCode::invalid_data,
                 fmt::format("the range of '{}' that was asked for is {} to {}, but must ascend", field.name,
                             shortest(range.lower), shortest(range.upper))};
}

} // namespace isotet::jobs
