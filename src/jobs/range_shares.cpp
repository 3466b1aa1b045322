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

bool are_of_points(const std::vector<IsovalueShare>& shares) {
    return std::ranges::all_of(shares,
                               [](const IsovalueShare& share) { return share.of == IsovalueShare::Of::points; });
}

std::function<Result<std::vector<double>>(const PointField& field)>
isovalues_by_values(std::vector<double> isovalues, std::vector<IsovalueShare> shares) {
    return [others = std::move(isovalues), shares = std::move(shares)](const PointField& field) {
        Result<std::vector<double>> all = isovalues_at({}, field, shares);
        if (all) all->insert(all->end(), others.begin(), others.end());
        return all;
    };
}

} // namespace isotet::jobs
