// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/isovalues.hpp>

#include <algorithm>
#include <cmath>

namespace isotet {

namespace {

/// The nearest multiple of a power of ten, as its decimal is read: 0.1 and not 0.1000000000000001.
double rounded_to_power(double value, double power) {
    const double count = std::round(value / power);
    return power < 1 ? count / std::round(1 / power) : count * std::round(power);
}

} // namespace

std::vector<double> evenly_spaced_levels(double lower, double upper, std::uint64_t count, LevelRounding rounding) {
    std::vector<double> levels;
    if (!(lower <= upper) || !std::isfinite(lower) || !std::isfinite(upper)) return levels;
    const auto parts = static_cast<double>(count) + 1;
    for (std::uint64_t k = 1; k <= count; ++k) {
        const auto part = static_cast<double>(k);
        const double level = lower + part * (upper - lower) / parts;
        // Where upper - lower overflows, the same sum in another order.
        levels.push_back(std::isfinite(level) ? level : lower * (1 - part / parts) + upper * (part / parts));
    }
    if (rounding == LevelRounding::none) return levels;
    const double step = upper / parts - lower / parts;
    const double power = step > 0 ? std::pow(10.0, std::floor(std::log10(step)) - 1) : 0;
    for (double& level : levels) {
        const double rounded = power > 0 && std::isfinite(1 / power) ? rounded_to_power(level, power) : level;
        if (std::isfinite(rounded)) level = rounded;
    }
    levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
    return levels;
}

} // namespace isotet
