// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/surface_record.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace isotet::jobs {

namespace {

/// The numbers of a record; none where it is not there, or one is not finite.
std::span<const double> find_record(const std::vector<Field>& field_data, std::string_view name) {
    const auto record = std::ranges::find(field_data, name, &Field::name);
    if (record == field_data.end() || record->values.type() != ScalarType::float64) return {};
    const auto values = record->values.as<double>();
    if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); })) return {};
    return values;
}

} // namespace

Field refinement_record(const RefineOptions& options) {
    std::vector<double> values{options.tolerance, options.relative_tolerance, options.geometry_tolerance,
                               options.distance};
    values.insert(values.end(), options.isovalues.begin(), options.isovalues.end());
    return {std::string(refinement_record_name), Array::own(std::move(values))};
}

std::optional<RefineOptions> find_refinement_record(const std::vector<Field>& field_data) {
    constexpr std::size_t tolerances = 4;
    const std::span<const double> values = find_record(field_data, refinement_record_name);
    if (values.size() <= tolerances) return std::nullopt;
    RefineOptions options;
    options.tolerance = values[0];
    options.relative_tolerance = values[1];
    options.geometry_tolerance = values[2];
    options.distance = values[3];
    options.isovalues.assign(values.begin() + tolerances, values.end());
    return options;
}

Field time_record(const SurfaceTime& time) {
    return {std::string(time_record_name), Array::own(std::vector<double>{time.time, static_cast<double>(time.step)})};
}

std::optional<SurfaceTime> find_time_record(const std::vector<Field>& field_data) {
    constexpr double too_many = 1e15; // steps
    const std::span<const double> values = find_record(field_data, time_record_name);
    if (values.size() != 2 || !(values[1] >= 0 && values[1] < too_many)) return std::nullopt;
    return SurfaceTime{values[0], static_cast<std::size_t>(values[1])};
}

} // namespace isotet::jobs
