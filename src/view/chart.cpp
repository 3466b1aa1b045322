// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/chart.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <isotet/fields.hpp>
#include <isotet/isovalues.hpp>

namespace isotet::view {

namespace {

constexpr std::size_t max_counted = std::size_t{1} << 20;

double place_in_chart(double part, const Chart& chart) { return chart.lower + part * (chart.upper - chart.lower); }

void count_points(const Array& values, Chart& chart) {
    const double scale = Chart::bins / (chart.upper - chart.lower);
    values.visit([&](auto scalars) {
        const std::size_t step = std::max<std::size_t>(1, scalars.size() / max_counted);
        for (std::size_t i = 0; i < scalars.size(); i += step) {
            const auto value = static_cast<double>(scalars[i]);
            if (!std::isfinite(value)) continue;
            const auto bin = static_cast<std::size_t>(std::max(0.0, (value - chart.lower) * scale));
            ++chart.points[std::min(bin, Chart::bins - 1)];
        }
    });
}

/// The value below which half of the triangles are, as a short decimal.
double first_isovalue(const Chart& chart) {
    const double all = std::accumulate(chart.triangles.begin(), chart.triangles.end(), 0.0);
    double below = 0, part = 0.5;
    for (std::size_t i = 0; i < Chart::bins && all > 0; ++i) {
        below += chart.triangles[i];
        if (below < all / 2) continue;
        part = (static_cast<double>(i) + 0.5) / Chart::bins;
        break;
    }
    constexpr double share = 0.2; // of the range: a tenth of that is what the value is rounded to
    const double value = place_in_chart(part, chart), room = share * (chart.upper - chart.lower);
    const auto levels = evenly_spaced_levels(value - room, value + room, 1, LevelRounding::short_decimals);
    return levels.empty() ? value : std::clamp(levels.front(), chart.lower, chart.upper);
}

} // namespace

Result<Chart> chart_of(const Array& values, const std::function<double(double isovalue)>& triangles, const Run& run) {
    const auto statistics = statistics_of(values, run);
    if (!statistics) return statistics.error();
    Chart chart;
    chart.points.resize(Chart::bins);
    chart.triangles.resize(Chart::bins);
    if (statistics->empty()) return chart;
    chart.lower = statistics->front().lower;
    chart.upper = statistics->front().upper;
    chart.no_data = statistics->front().not_a_number;
    chart.first = chart.lower;
    if (!(chart.lower < chart.upper) || !std::isfinite(chart.upper - chart.lower)) return chart;
    count_points(values, chart);
    for (std::size_t i = 0; i < Chart::bins; ++i)
        chart.triangles[i] = triangles(place_in_chart((static_cast<double>(i) + 0.5) / Chart::bins, chart));
    chart.first = first_isovalue(chart);
    return chart;
}

Result<Chart> chart_of(const Grid& grid, const PointField& field, const Run& run) {
    const Result<FieldSample> sample = FieldSample::create(grid, field);
    if (!sample) return sample.error();
    return chart_of(field.values, [&](double isovalue) { return sample->triangles(isovalue); }, run);
}

} // namespace isotet::view
