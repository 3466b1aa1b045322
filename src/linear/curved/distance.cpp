// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/distance.hpp"

#include <algorithm>
#include <atomic>

#include "base/parallel.hpp"

namespace isotet::linear {

namespace {

/// The length of the gradient at a corner of a quadratic tet: along an edge a field begins to rise as to twice the Bezier
/// value of the edge.
double slope_at_corner(std::size_t corner, const std::array<double, 10>& value,
                       const std::array<std::array<double, 10>, 3>& place) {
    std::array<double, 3> rise{};
    std::array<Point, 3> along{};
    for (std::size_t other = 0, i = 0; other < 4; ++other) {
        if (other == corner) continue;
        const std::size_t edge = 4u + tet_edge_of[corner][other];
        const auto begins = [&](const std::array<double, 10>& v) { return 4 * v[edge] - 3 * v[corner] - v[other]; };
        rise[i] = begins(value);
        for (std::size_t k = 0; k < 3; ++k) along[i][k] = begins(place[k]);
        ++i;
    }
    return slope(along, rise);
}

/// 2 to the power of -3/4, -1/2, -1/4 and 0.
constexpr std::array<double, 4> quarters{0.59460355750136053, 0.70710678118654752, 0.84089641525371454, 1};

/// The same for any order of calls.
void keep_least(double& to, double value) {
    std::atomic_ref shared(to);
    double seen = shared.load(std::memory_order_relaxed);
    while (value < seen && !shared.compare_exchange_weak(seen, value, std::memory_order_relaxed)) {}
}

} // namespace

void DistanceCounts::add(double distance) {
    largest_ = std::max(largest_, distance);
    int power = 0;
    const double part = std::frexp(distance, &power); // 0.5 to 1
    const auto quarter = std::ranges::lower_bound(quarters, part) - quarters.begin();
    if (!(distance > 0) || power < lowest) ++counts_.front();
    else if (!std::isfinite(distance) || power >= highest) ++counts_.back();
    else ++counts_[static_cast<std::size_t>(4 * (power - lowest) + static_cast<int>(quarter))];
}

void DistanceCounts::add(const DistanceCounts& other) {
    largest_ = std::max(largest_, other.largest_);
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
}

double DistanceCounts::not_exceeded_by(double share) const {
    std::uint64_t all = 0, below = 0;
    for (const std::uint64_t count : counts_) all += count;
    for (std::size_t i = 0; i + 1 < counts_.size(); ++i) {
        below += counts_[i];
        if (static_cast<double>(below) >= share * static_cast<double>(all))
            return std::min(largest_, std::ldexp(quarters[i % 4], static_cast<int>(i / 4) + lowest));
    }
    return largest_;
}

std::vector<double> deviations_for(double distance, double floor, double most, const QuadraticTets& tets,
                                   const NodeValues& values, const std::array<NodeValues, 3>& places,
                                   std::uint64_t points) {
    std::vector<double> slopes(points, std::numeric_limits<double>::infinity());
    core::parallel_each(tets.tets.size(), 1 << 12, [&](std::size_t i) {
        const QuadraticTet& tet = tets.tets[i];
        const auto value = values.of(tet);
        const std::array<std::array<double, 10>, 3> place{places[0].of(tet), places[1].of(tet), places[2].of(tet)};
        for (std::size_t corner = 0; corner < 4; ++corner) {
            const double found = slope_at_corner(corner, value, place);
            if (!std::isnan(found)) keep_least(slopes[tet[corner]], found);
        }
    });
    for (double& slope : slopes) slope = std::clamp(distance * slope / error_per_deviation, floor, most);
    return slopes;
}

} // namespace isotet::linear
