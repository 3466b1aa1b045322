// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "scene/hiding.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace isotet {

namespace scene {

namespace {

constexpr std::size_t side = 24;           ///< cells of a view, an axis
constexpr double depth_slack = 3.0 / side; ///< of a surface that is seen at a slant in one cell

/// Axes of the picture and of the view, of unit length.
struct Direction {
    std::array<double, 3> across, down, along;
};

/// The axes and the diagonals of a cube; each is looked along both ways.
constexpr std::array<Direction, 7> directions() {
    constexpr double h = 0.70710678118654752, t = 0.57735026918962576, s = 0.40824829046386302;
    return {{{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}},
             {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
             {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
             {{h, -h, 0}, {s, s, -2 * s}, {t, t, t}},
             {{h, h, 0}, {s, -s, 2 * s}, {t, -t, -t}},
             {{h, h, 0}, {-s, s, 2 * s}, {-t, t, -t}},
             {{h, -h, 0}, {-s, -s, -2 * s}, {-t, -t, t}}}};
}

double along(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

} // namespace

Hiding::Hiding(std::span<const SurfacePoints> surfaces)
    : count_(surfaces.size()), hidden_(count_ * count_), seen_(count_) {
    if (count_ < 2) return;
    double square = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double lower = INFINITY, upper = -INFINITY;
        for (const SurfacePoints& points : surfaces)
            for (const std::array<double, 3>& point : points) {
                lower = std::min(lower, point[axis]);
                upper = std::max(upper, point[axis]);
            }
        if (lower > upper) return; // there are no points
        centre_[axis] = lower / 2 + upper / 2;
        square += (upper / 2 - lower / 2) * (upper / 2 - lower / 2);
    }
    scale_ = square > 0 ? 1 / std::sqrt(square) : 1;
    for (const Direction& view : directions()) look_along(surfaces, view.across, view.down, view.along);
}

void Hiding::look_along(std::span<const SurfacePoints> surfaces, const std::array<double, 3>& across,
                        const std::array<double, 3>& down, const std::array<double, 3>& view) {
    struct Seen {
        std::size_t cell;
        double height;
    };
    struct Heights {
        double lowest = INFINITY, highest = -INFINITY;
    };
    const auto seen = [&](const std::array<double, 3>& point) {
        std::array<double, 3> place{};
        for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = (point[axis] - centre_[axis]) * scale_;
        const auto cell = [](double at) {
            const double place_in_view = (at + 1) / 2 * side;
            return place_in_view > 0 ? static_cast<std::size_t>(std::min(place_in_view, side - 1.0)) : 0;
        };
        return Seen{cell(along(place, down)) * side + cell(along(place, across)), along(place, view)};
    };
    std::vector<Heights> heights(count_ * side * side);
    for (std::size_t i = 0; i < count_; ++i)
        for (const std::array<double, 3>& point : surfaces[i]) {
            const auto [cell, height] = seen(point);
            Heights& at = heights[i * side * side + cell];
            at.lowest = std::min(at.lowest, height);
            at.highest = std::max(at.highest, height);
        }
    for (std::size_t b = 0; b < count_; ++b)
        for (const std::array<double, 3>& point : surfaces[b]) {
            const auto [cell, height] = seen(point);
            const Heights& own = heights[b * side * side + cell];
            const bool from_above = height > own.highest - depth_slack, from_below = height < own.lowest + depth_slack;
            seen_[b] += static_cast<std::size_t>(from_above) + static_cast<std::size_t>(from_below);
            for (std::size_t a = 0; a < count_; ++a) {
                const Heights& other = heights[a * side * side + cell];
                hidden_[a * count_ + b] += static_cast<std::size_t>(from_above && other.highest > height) +
                                           static_cast<std::size_t>(from_below && other.lowest < height);
            }
        }
}

} // namespace scene

std::vector<std::vector<std::size_t>> hidden_by(std::span<const SurfacePoints> points) {
    const scene::Hiding hiding(points);
    std::vector<std::vector<std::size_t>> hidden(points.size());
    for (std::size_t a = 0; a < points.size(); ++a)
        for (std::size_t b = 0; b < points.size(); ++b)
            if (hiding.hides(a, b)) hidden[a].push_back(b);
    return hidden;
}

SurfacePoints some_points_of(const Surface& surface) {
    constexpr std::size_t most = 2048;
    SurfacePoints points;
    const std::size_t count = surface.vertex_count(), step = (count + most - 1) / most;
    for (std::size_t i = 0; i < count; i += step) {
        const std::array<double, 3> place{surface.positions.at(i, 0), surface.positions.at(i, 1),
                                          surface.positions.at(i, 2)};
        if (std::ranges::all_of(place, [](double at) { return std::isfinite(at); })) points.push_back(place);
    }
    return points;
}

} // namespace isotet
