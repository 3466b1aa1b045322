// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/isovalues.hpp>

#include <array>
#include <cmath>

#include <fmt/core.h>

#include <isotet/engine.hpp>
#include <isotet/fields.hpp>

#include "api/spectrum_source.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"

namespace isotet {

namespace {

constexpr std::size_t max_spectrum_isovalues = 65'536;

Result<void> check_spectrum_isovalues(std::span<const double> isovalues) {
    if (isovalues.empty() || isovalues.size() > max_spectrum_isovalues)
        return invalid_argument(
            fmt::format("{} isovalues, but there must be 1 to {}", isovalues.size(), max_spectrum_isovalues));
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        if (!std::isfinite(isovalues[i]))
            return invalid_argument(fmt::format("isovalues[{}] is {}, but must be finite", i, isovalues[i]));
        if (i > 0 && isovalues[i] < isovalues[i - 1])
            return invalid_argument(
                fmt::format("isovalues[{}] is {}, less than the one before, {}, but they must ascend", i, isovalues[i],
                            isovalues[i - 1]));
    }
    return {};
}

Result<void> check_steps(std::uint64_t steps) {
    if (steps >= 1 && steps < max_spectrum_isovalues) return {};
    return invalid_argument(fmt::format("{} steps, but there must be 1 to {}", steps, max_spectrum_isovalues - 1));
}

Result<ContourSpectrum> spectrum_by(const Grid& grid, const PointField& field, std::span<const double> isovalues,
                                    api::SpectrumBy engine, const Run& run) {
    return core::carry_out("measuring", run, [&](const Progress& progress) -> Result<ContourSpectrum> {
        if (auto ok = check_spectrum_isovalues(isovalues); !ok) return ok.error();
        auto source = api::SpectrumSource::open(grid, field, {isovalues.front(), isovalues.back()}, progress);
        if (!source) return source.error();
        return source->at(isovalues, engine, progress);
    });
}

} // namespace

Result<ContourSpectrum> contour_spectrum(const Grid& grid, const PointField& field, std::span<const double> isovalues,
                                         const Run& run) {
    return spectrum_by(grid, field, isovalues, api::SpectrumBy::cpu, run);
}

Result<ContourSpectrum> contour_spectrum_over_range(const Grid& grid, const PointField& field, std::uint64_t steps,
                                                    const Run& run) {
    if (auto ok = check_steps(steps); !ok) return ok.error();
    const auto statistics = statistics_of(field.values, run);
    if (!statistics) return statistics.error();
    if (statistics->size() != 1) return contour_spectrum(grid, field, std::array{0.0}, run); // which says what is wrong
    return contour_spectrum_over_range(grid, field, steps, {statistics->front().lower, statistics->front().upper}, run);
}

Result<ContourSpectrum> contour_spectrum_over_range(const Grid& grid, const PointField& field, std::uint64_t steps,
                                                    const ValueRange& range, const Run& run) {
    if (auto ok = check_steps(steps); !ok) return ok.error();
    const auto [lower, upper] = range;
    if (!(lower <= upper)) return ContourSpectrum{};
    std::vector<double> isovalues{lower};
    if (lower < upper) {
        const auto between = evenly_spaced_levels(lower, upper, steps - 1);
        isovalues.insert(isovalues.end(), between.begin(), between.end());
        isovalues.push_back(upper);
    }
    return contour_spectrum(grid, field, isovalues, run);
}

Result<ContourSpectrum> contour_spectrum_by_reference(const Grid& grid, const PointField& field,
                                                      std::span<const double> isovalues, const Run& run) {
    return spectrum_by(grid, field, isovalues, api::SpectrumBy::reference, run);
}

} // namespace isotet
