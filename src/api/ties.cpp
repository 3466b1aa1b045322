// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "api/ties.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "base/prefetch.hpp"
#include "numbers/storage.hpp"

namespace isotet {

double snap(const Array& values, double isovalue) {
    return values.visit([&]<class T>(std::span<const T>) {
        if constexpr (std::is_same_v<T, double>) return isovalue;
        else if constexpr (std::is_same_v<T, float>) {
            const double nearest = core::rounded_to_float(isovalue);
            return std::isinf(nearest) ? std::copysign(double{std::numeric_limits<float>::max()}, isovalue) : nearest;
        } else {
            const auto lower = static_cast<double>(std::numeric_limits<T>::min());
            const auto upper = static_cast<double>(std::numeric_limits<T>::max());
            return std::min(std::max(std::nearbyint(isovalue), lower), upper);
        }
    });
}

namespace api {

namespace {

/// Calls f(packed point) for every own point with this stored value, in parallel.
template <class Real, class F>
void for_points_with(const core::Packed& packed, Real stored, const F& f) {
    const auto& reals = packed.as<Real>();
    const auto values_of = [&](std::uint32_t c) { return reals.values.data() + packed.headers[c].first_point; };
    // Which clusters may hold it is as good as random: they are listed first, without a branch each, and their values asked
    // for before they are looked at.
    constexpr std::size_t at_once = 512, ahead = 8;
    core::parallel_each((packed.clusters() + at_once - 1) / at_once, 2, [&](std::size_t part) {
        std::array<std::uint32_t, at_once + 1> hits;
        std::size_t count = 0;
        for (std::size_t c = at_once * part, end = std::min(packed.clusters(), c + at_once); c < end; ++c) {
            hits[count] = static_cast<std::uint32_t>(c);
            count += unsigned{reals.ranges[c].lower <= stored} & unsigned{stored <= reals.ranges[c].upper};
        }
        for (std::size_t i = 0; i < count; ++i) {
            if (i + ahead < count)
                core::prefetch_bytes(values_of(hits[i + ahead]), sizeof(Real) * core::max_cluster_points / 2);
            const core::ClusterHeader& h = packed.headers[hits[i]];
            const Real* const values = values_of(hits[i]);
            unsigned any = 0; // mostly none: found without a branch a point
            for (std::size_t k = 0; k < h.own_points; ++k) any |= values[k] == stored;
            for (std::size_t k = 0; any && k < h.own_points; ++k)
                if (values[k] == stored) f(h.first_point + k);
        }
    });
}

} // namespace

template <class Real>
void report_ties(const core::Packed& packed, double isovalue, const core::StoredIsovalue<Real>& stored,
                 std::uint64_t tied_points, ExtractReport& report) {
    report.isovalue_stored = core::restore_value(stored.sum(), packed.storage);
    report.tied_points = tied_points;
    const bool all_exact = packed.storage.unchanged && packed.field_report.flushed == 0;
    if (!all_exact && packed.field.empty()) return;
    const auto holds_exactly = [&](std::uint64_t point, double value) {
        if (all_exact)
            return core::restore_value(static_cast<double>(packed.as<Real>().values[point]), packed.storage) == value;
        return packed.field.visit(
            [&](auto values) { return core::equals_exactly(values[packed.user_point(point)], value); });
    };
    if (tied_points) {
        std::atomic<std::uint64_t> exact{0};
        for_points_with(packed, stored.tied, [&](std::uint64_t point) {
            if (holds_exactly(point, isovalue)) exact.fetch_add(1, std::memory_order_relaxed);
        });
        report.false_ties = tied_points - exact;
        return;
    }
    report.false_ties = 0;
    const double nearest = snap(packed.field, isovalue);
    const Real nearest_stored = core::store_value<Real>(nearest, packed.storage);
    if (nearest == isovalue || nearest_stored == stored.tied) return;
    std::atomic<bool> near{false};
    for_points_with(packed, nearest_stored, [&](std::uint64_t point) {
        if (holds_exactly(point, nearest)) near.store(true, std::memory_order_relaxed);
    });
    report.near_tie = near;
}

template void report_ties<float>(const core::Packed&, double, const core::StoredIsovalue<float>&, std::uint64_t,
                                 ExtractReport&);
template void report_ties<double>(const core::Packed&, double, const core::StoredIsovalue<double>&, std::uint64_t,
                                  ExtractReport&);

} // namespace api
} // namespace isotet
