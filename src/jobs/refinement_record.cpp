// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/refinement_record.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace isotet::jobs {

Field refinement_record(const RefineOptions& options) {
    std::vector<double> values{options.tolerance, options.relative_tolerance, options.geometry_tolerance,
                               options.distance};
    values.insert(values.end(), options.isovalues.begin(), options.isovalues.end());
    return {std::string(refinement_record_name), Array::own(std::move(values))};
}

std::optional<RefineOptions> find_refinement_record(const std::vector<Field>& field_data) {
    constexpr std::size_t tolerances = 4;
    const auto record = std::ranges::find(field_data, refinement_record_name, &Field::name);
    if (record == field_data.end() || record->values.type() != ScalarType::float64) return std::nullopt;
    const auto values = record->values.as<double>();
    if (values.size() <= tolerances || !std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
        return std::nullopt;
    RefineOptions options;
    options.tolerance = values[0];
    options.relative_tolerance = values[1];
    options.geometry_tolerance = values[2];
    options.distance = values[3];
    options.isovalues.assign(values.begin() + tolerances, values.end());
    return options;
}

} // namespace isotet::jobs
