// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/field_statistics.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/carry_out.hpp"
#include "base/parallel.hpp"

namespace isotet {

namespace {

constexpr std::size_t statistics_grain = std::size_t{1} << 16;
constexpr std::size_t max_sampled_values = 200'000;

void add_value(ComponentStatistics& total, double value) {
    if (std::isnan(value)) ++total.not_a_number;
    else if (std::isinf(value)) ++total.infinite;
    else {
        total.lower = std::min(total.lower, value);
        total.upper = std::max(total.upper, value);
    }
}

void add_part(ComponentStatistics& total, const ComponentStatistics& part) {
    total.lower = std::min(total.lower, part.lower);
    total.upper = std::max(total.upper, part.upper);
    total.not_a_number += part.not_a_number;
    total.infinite += part.infinite;
}

/// The finite ones among the sampled values, magnitudes of vectors; and how many were sampled.
struct SampledValues {
    std::vector<double> values;
    std::size_t taken = 0;
};

SampledValues sample_values(const Array& array) {
    SampledValues sample;
    const std::size_t step = array.tuples() / max_sampled_values + 1, components = array.components();
    array.visit([&](auto scalars) {
        for (std::size_t tuple = 0; tuple < array.tuples(); tuple += step, ++sample.taken) {
            double sum = 0;
            for (std::size_t c = 0; c < components; ++c) {
                const auto scalar = static_cast<double>(scalars[tuple * components + c]);
                sum = components == 1 ? scalar : sum + scalar * scalar;
            }
            const double value = components == 1 ? sum : std::sqrt(sum);
            if (std::isfinite(value)) sample.values.push_back(value);
        }
    });
    return sample;
}

/// How much a field varies; 0: not at all.
double variation_of(const SampledValues& sample) {
    if (sample.values.empty()) return 0;
    const auto [low, high] = std::minmax_element(sample.values.begin(), sample.values.end());
    if (!(*low < *high)) return 0;
    std::array<double, 64> bins{};
    for (const double value : sample.values) { // halves: the difference of two doubles may overflow
        const double place = (value / 2 - *low / 2) / (*high / 2 - *low / 2) * bins.size();
        bins[std::min(bins.size() - 1, static_cast<std::size_t>(place))] += 1;
    }
    double entropy = 0;
    const auto count = static_cast<double>(sample.values.size());
    for (const double bin : bins)
        if (bin > 0) entropy -= bin / count * std::log(bin / count);
    return entropy * count / static_cast<double>(sample.taken);
}

/// Not so for vectors, whose magnitudes are looked at.
bool holds_whole_numbers(const Array& array, const SampledValues& sample) {
    return !is_floating(array.type()) ||
           (array.components() == 1 &&
            std::ranges::all_of(sample.values, [](double value) { return value == std::floor(value); }));
}

} // namespace

Result<std::vector<ComponentStatistics>> statistics_of(const Array& values, const Run& run) {
    using Statistics = std::vector<ComponentStatistics>;
    return core::carry_out("describing a field", run, [&](const Progress& progress) -> Result<Statistics> {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        const std::size_t components = values.components();
        const ComponentStatistics nothing{infinity, -infinity, 0, 0};
        Statistics totals(components, nothing);
        std::mutex mutex;
        values.visit([&](auto scalars) {
            const std::size_t grain = std::max<std::size_t>(statistics_grain / std::max<std::size_t>(components, 1), 1);
            core::parallel_pieces(values.tuples(), grain, progress, [&](std::size_t begin, std::size_t end) {
                Statistics parts(components, nothing);
                for (std::size_t tuple = begin; tuple < end; ++tuple)
                    for (std::size_t c = 0; c < components; ++c)
                        add_value(parts[c], static_cast<double>(scalars[tuple * components + c]));
                const std::lock_guard lock(mutex);
                for (std::size_t c = 0; c < components; ++c) add_part(totals[c], parts[c]);
            });
        });
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "describing a field was cancelled"};
        return totals;
    });
}

ValueRange typical_range(const Array& array) {
    constexpr std::size_t rare = 50;
    std::vector<double> values = sample_values(array).values;
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const ValueRange range{values[values.size() / rare], values[values.size() - 1 - values.size() / rare]};
    return range.lower < range.upper ? range : ValueRange{values.front(), values.back()};
}

DefaultField default_field(const Grid& grid) {
    DefaultField chosen;
    double most = 0;
    for (const auto* fields : {&grid.point_fields, &grid.cell_fields}) {
        for (const auto& [name, values] : *fields) {
            if (values.components() != 1 && values.components() != 3) continue;
            const SampledValues sample = sample_values(values);
            const double variation = variation_of(sample);
            const bool whole = holds_whole_numbers(values, sample);
            const bool better = whole == chosen.whole_numbers || chosen.name.empty() ? variation > most : !whole;
            if (variation == 0 || !better) continue;
            most = variation;
            chosen = {name + (values.components() == 3 ? ":mag" : ""), whole};
        }
    }
    return chosen;
}

} // namespace isotet
