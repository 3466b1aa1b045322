// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fields/sampled_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace isotet::core {

namespace {

constexpr std::size_t max_sampled_values = 200'000;

} // namespace

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

bool holds_whole_numbers(const Array& array, const SampledValues& sample) {
    return !is_floating(array.type()) ||
           (array.components() == 1 &&
            std::ranges::all_of(sample.values, [](double value) { return value == std::floor(value); }));
}

} // namespace isotet::core
