// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/volume/transfer.hpp"

#include <cmath>

#include "render/color/linear_light.hpp"

namespace isotet::render {

namespace {

constexpr double most_opaque = 0.99999;

/// The integral of depth_of() from 0 to an opacity.
double depth_up_to(double opacity) {
    const double through = 1 - opacity;
    return through > 0 ? through * std::log(through) + opacity : opacity;
}

/// The integral of the optical depth over values from a to b, between which the opacity goes from `at_a` to `at_b`.
double depth_between(double a, double b, double at_a, double at_b) {
    const double from = std::min(at_a, most_opaque), to = std::min(at_b, most_opaque);
    if (std::abs(to - from) < 1e-6) return (b - a) * depth_of(0.5 * (from + to));
    return (b - a) * (depth_up_to(to) - depth_up_to(from)) / (to - from);
}

Light color_of(const ColorScale& scale, double value) {
    const double place = std::min(std::max(scale.place_of(value), 0.0), 1.0);
    if (scale.classes.empty()) return linear_light(scale.color_at(place));
    const auto which = static_cast<std::size_t>(place * static_cast<double>(scale.classes.size()));
    return linear_light(scale.classes[std::min(which, scale.classes.size() - 1)]);
}

/// The smallest range of values outside of which nothing is opaque; empty where nothing is. Where the field ends in it
/// there is room beyond its last value.
ValueRange opaque_range(const OpacityCurve& opacity, double lower, double upper) {
    const std::vector<OpacityPoint>& points = opacity.points;
    const auto is_opaque = [](const OpacityPoint& point) { return point.opacity > 0; };
    const auto first = std::ranges::find_if(points, is_opaque);
    if (first == points.end()) return {};
    const auto last = std::ranges::find_if(points.rbegin(), points.rend(), is_opaque);
    const double room = (upper - lower) / static_cast<double>(Transfer::entries);
    ValueRange range{lower - room, upper + room};
    if (first != points.begin()) range.lower = std::max(range.lower, (first - 1)->value);
    if (last != points.rbegin()) range.upper = std::min(range.upper, (last - 1)->value);
    return range;
}

/// Adds the integral from a to b, cut at the points of the opacity between them.
void add_depths(Extinction& sum, const DrawnVolume& volume, double a, double b, double weight) {
    const std::vector<OpacityPoint>& points = volume.opacity.points;
    auto next = std::ranges::upper_bound(points, a, {}, &OpacityPoint::value);
    double at_a = volume.opacity.at(a);
    while (a < b) {
        const bool ends_at_point = next != points.end() && next->value < b;
        const double end = ends_at_point ? next->value : b;
        // At a step the opacity from below is that of its first point.
        const double at_end =
            ends_at_point || (next != points.end() && next->value == b) ? next->opacity : volume.opacity.at(end);
        const double depth = depth_between(a, end, at_a, at_end) * weight;
        const Light color = color_of(volume.scale, 0.5 * (a + end));
        sum[0] += depth;
        for (std::size_t i = 0; i < 3; ++i) sum[i + 1] += depth * double{color[i]};
        a = end;
        if (!ends_at_point) break;
        while (next != points.end() && next->value <= a) ++next;
        at_a = volume.opacity.at(a);
    }
}

Extinction extinction_at(const DrawnVolume& volume, double value) {
    const double depth = depth_of(volume.opacity.at(value)) / volume.opacity_length;
    const Light color = color_of(volume.scale, value);
    return {depth, depth * double{color[0]}, depth * double{color[1]}, depth * double{color[2]}};
}

} // namespace

double depth_of(double opacity) { return -std::log(1 - std::min(opacity, most_opaque)); }

Transfer::Transfer(const DrawnVolume& volume, double lower, double upper, const core::Storage& storage)
    : rows_(entries), storage_(storage) {
    const ColorScale& scale = volume.scale;
    ValueRange range = opaque_range(volume.opacity, lower, upper);
    if (!(range.lower < range.upper)) { // one value, or nothing
        const double value = range.lower <= range.upper ? range.lower : lower;
        const double half = value == 0 ? 1 : std::abs(value) / 2;
        range = {value - half, value + half};
    }
    constexpr auto count = static_cast<double>(entries);
    if (scale.logarithmic) {
        lowest_ = std::max(range.lower, scale.lower * 1e-3);
        range = {lowest_, std::max(range.upper, 2 * lowest_)};
        log_factor_ = count / std::log(range.upper / range.lower);
        shift_ = -std::log(range.lower) * log_factor_;
    } else {
        factor_ = count / ((range.upper - range.lower) * storage.scale);
        shift_ = (storage.offset - range.lower) * count / (range.upper - range.lower);
    }
    const auto value_at = [&](std::size_t i) {
        const double part = static_cast<double>(i) / count;
        return log_factor_ == 0 ? (1 - part) * range.lower + part * range.upper
                                : range.lower * std::exp(part * std::log(range.upper / range.lower));
    };
    Extinction sum{};
    for (std::size_t i = 0; i < entries; ++i) {
        const double a = value_at(i), b = value_at(i + 1), inside = (b - a) * 1e-6;
        Extinction mean{};
        add_depths(mean, volume, a, b, 1 / ((b - a) * volume.opacity_length));
        rows_[i] = row_between(sum, mean, extinction_at(volume, a + inside), extinction_at(volume, b - inside));
        for (std::size_t k = 0; k < 4; ++k) sum[k] += mean[k];
    }
}

/// Extinction linear between two entries, with this mean, and as far as it does not fall below 0 with these ends.
Transfer::Row Transfer::row_between(const Extinction& up_to, const Extinction& mean, const Extinction& begin,
                                    const Extinction& end) {
    Row row;
    row.up_to = up_to;
    for (std::size_t k = 0; k < 4; ++k) {
        const double bend = std::min(std::max(0.5 * (end[k] - begin[k]), -mean[k]), mean[k]);
        row.bend[k] = static_cast<float>(bend);
        row.rise[k] = static_cast<float>(mean[k] - bend);
    }
    return row;
}

float Transfer::log_place_of(double stored) const {
    if (core::is_nan(stored)) return core::canonical_nan<float>();
    const double value = std::max(core::restore_value(stored, storage_), lowest_ * 0.5);
    return static_cast<float>(std::log(value) * log_factor_ + shift_);
}

} // namespace isotet::render
