// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/scene.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/core.h>

#include <isotet/isovalues.hpp>

#include "base/errors.hpp"

namespace isotet {

namespace {

constexpr double single_opacity = 0.35, peak_opacity = 0.98;
constexpr std::uint64_t most_peaks = 100;

std::optional<double> number_of(std::string_view text) {
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return {};
    return number;
}

Error wrong_opacity(std::string_view text, const std::string& what) {
    return invalid_argument(fmt::format(
        "the opacity '{}' {}; such texts are VALUE:OPACITY,VALUE:OPACITY,..., ramp, peaks, peaks:N and shell", text,
        what));
}

Result<OpacityText> parse_peaks(std::string_view text, std::string_view count) {
    std::uint64_t peaks = 0;
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), peaks);
    if (error != std::errc() || end != count.data() + count.size() || peaks < 1 || peaks > most_peaks)
        return wrong_opacity(text, fmt::format("has '{}' peaks, but there are 1 to {}", count, most_peaks));
    return OpacityText{{}, OpacityPreset::peaks, peaks};
}

/// Piecewise opacity of triangles around the levels; where they are near each other their feet meet.
OpacityCurve peaks_at(std::span<const double> levels, const ValueRange& range) {
    OpacityCurve curve;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        double below = (range.upper - range.lower) / 30, above = below;
        if (i > 0) below = std::min(below, (levels[i] - levels[i - 1]) / 2);
        if (i + 1 < levels.size()) above = std::min(above, (levels[i + 1] - levels[i]) / 2);
        curve.points.insert(curve.points.end(),
                            {{levels[i] - below, 0}, {levels[i], peak_opacity}, {levels[i] + above, 0}});
    }
    return curve;
}

} // namespace

double OpacityCurve::at(double value) const noexcept {
    if (points.empty()) return 0;
    const auto above = std::ranges::upper_bound(points, value, {}, &OpacityPoint::value);
    if (above == points.begin()) return points.front().opacity;
    const OpacityPoint& below = *(above - 1);
    if (above == points.end()) return below.opacity;
    return below.opacity + (above->opacity - below.opacity) * ((value - below.value) / (above->value - below.value));
}

bool OpacityCurve::is_transparent() const noexcept {
    return std::ranges::all_of(points, [](const OpacityPoint& point) { return point.opacity == 0; });
}

Result<void> OpacityCurve::check() const {
    for (std::size_t i = 0; i < points.size(); ++i) {
        const auto [value, opacity] = points[i];
        if (!std::isfinite(value))
            return invalid_argument(
                fmt::format("point {} of the opacity has the value {}, but values must be finite", i + 1, value));
        if (!(opacity >= 0 && opacity <= 1))
            return invalid_argument(
                fmt::format("point {} of the opacity has {}, but opacity must be from 0 to 1", i + 1, opacity));
        if (i > 0 && value < points[i - 1].value)
            return invalid_argument(
                fmt::format("point {} of the opacity has the value {} behind {}, but values must ascend", i + 1, value,
                            points[i - 1].value));
    }
    return {};
}

Result<OpacityText> parse_opacity(std::string_view text) {
    if (text == "ramp") return OpacityText{{}, OpacityPreset::ramp, 0};
    if (text == "shell") return OpacityText{{}, OpacityPreset::shell, 0};
    if (text == "peaks") return OpacityText{{}, OpacityPreset::peaks, 0};
    constexpr std::string_view counted = "peaks:";
    if (text.starts_with(counted)) return parse_peaks(text, text.substr(counted.size()));
    OpacityText parsed;
    if (text.empty()) return wrong_opacity(text, "has no points");
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        const std::string_view point = text.substr(begin, end - begin);
        const std::size_t colon = point.find(':');
        const std::optional<double> value = number_of(point.substr(0, colon)),
                                    opacity = number_of(colon == std::string_view::npos ? "" : point.substr(colon + 1));
        if (!value || !opacity)
            return wrong_opacity(text, fmt::format("has '{}' as point {}", point, parsed.curve.points.size() + 1));
        parsed.curve.points.push_back({*value, *opacity});
        begin = end + 1;
    }
    if (Result<void> right = parsed.curve.check(); !right) return right.error();
    return parsed;
}

OpacityCurve opacity_of(const OpacityText& text, const ValueRange& range) {
    if (!text.preset) return text.curve;
    constexpr std::uint64_t default_peaks = 3;
    const std::uint64_t peaks = text.peaks > 0 ? text.peaks : default_peaks;
    return opacity_of(*text.preset, range, evenly_spaced_levels(range.lower, range.upper, peaks));
}

OpacityCurve opacity_of(OpacityPreset preset, const ValueRange& range, std::span<const double> levels) {
    const double width = range.upper - range.lower;
    if (!(width > 0)) return {{{range.lower, single_opacity}}};
    switch (preset) {
    case OpacityPreset::peaks: return peaks_at(levels, range);
    case OpacityPreset::shell:
        return {{{range.lower + 0.1 * width, 0},
                 {range.lower + 0.2 * width, single_opacity},
                 {range.upper - 0.2 * width, single_opacity},
                 {range.upper - 0.1 * width, 0}}};
    default: return {{{range.lower, 0}, {range.upper, 0.6}}};
    }
}

} // namespace isotet
