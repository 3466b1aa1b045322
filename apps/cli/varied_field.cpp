// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "varied_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace isotet::cli {

namespace {

/// Values that a field is judged by, taken evenly from all of them.
constexpr std::size_t most_samples = 200'000;

/// The finite ones among the sampled values, magnitudes of vectors; and how many were sampled.
struct Sample {
    std::vector<double> values;
    std::size_t taken = 0;
};
Sample sample_of(const Array& array) {
    Sample sample;
    const std::size_t step = array.tuples() / most_samples + 1, components = array.components();
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

/// The nearest multiple of a power of ten, as its decimal is read: 0.1 and not 0.1000000000000001.
double rounded_to(double value, double power) {
    const double count = std::round(value / power);
    return power < 1 ? count / std::round(1 / power) : count * std::round(power);
}

double score_of(const Array& array) {
    if (array.components() != 1 && array.components() != 3) return 0;
    const Sample sample = sample_of(array);
    if (sample.values.empty()) return 0;
    const auto [low, high] = std::minmax_element(sample.values.begin(), sample.values.end());
    if (!(*low < *high)) return 0;
    std::array<double, 64> bins{};
    for (const double value : sample.values)
        bins[std::min(bins.size() - 1,
                      static_cast<std::size_t>((value / 2 - *low / 2) / (*high / 2 - *low / 2) * bins.size()))] += 1;
    double entropy = 0;
    const auto count = static_cast<double>(sample.values.size());
    for (const double bin : bins)
        if (bin > 0) entropy -= bin / count * std::log(bin / count);
    const bool whole = std::ranges::all_of(sample.values, [](double value) { return value == std::floor(value); });
    return entropy * (whole ? 0.5 : 1) * count / static_cast<double>(sample.taken);
}

} // namespace

std::string most_varied_field(const Grid& grid) {
    std::string name;
    double best = 0;
    for (const auto* fields : {&grid.point_fields, &grid.cell_fields}) {
        for (const Field& field : *fields) {
            const double score = score_of(field.values);
            if (score <= best) continue;
            best = score;
            name = field.name + (field.values.components() == 3 ? ":mag" : "");
        }
    }
    return name;
}

std::vector<double> levels_within(const PointField& field, std::uint64_t count) {
    constexpr std::size_t rare = 50;
    std::vector<double> values = sample_of(field.values).values;
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    double low = values[values.size() / rare], high = values[values.size() - 1 - values.size() / rare];
    if (!(low < high)) {
        low = values.front();
        high = values.back();
    }
    const double step = high / static_cast<double>(count + 1) - low / static_cast<double>(count + 1);
    const double power = std::pow(10.0, std::floor(std::log10(step)) - 1);
    std::vector<double> levels;
    for (std::uint64_t k = 1; k <= count; ++k) {
        const double level = low + static_cast<double>(k) * step;
        levels.push_back(power > 0 && std::isfinite(1 / power) ? rounded_to(level, power) : level);
    }
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    return levels;
}

} // namespace isotet::cli
