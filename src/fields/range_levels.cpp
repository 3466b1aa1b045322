// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/isovalues.hpp>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "fields/fill_values.hpp"

namespace isotet {

Result<std::vector<double>> RangeLevels::operator()(const PointField& field) const {
    if (!whole_range) return within(core::typical_range_of(field), field);
    const auto found = core::find_fill_values(field);
    if (!found) return found.error();
    return within(found->others, field);
}

Result<std::vector<double>> RangeLevels::within(const ValueRange& range, const PointField& field) const {
    std::vector<double> levels = evenly_spaced_levels(range.lower, range.upper, count, rounding);
    if (!levels.empty()) return levels;
    return invalid_data(fmt::format("field '{}' has no finite value: there is nothing to contour", field.name));
}

} // namespace isotet
