// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "api/ties.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/workers.hpp"
#include "base/prefetch.hpp"
#include "numbers/storage.hpp"
#include "packed/residency.hpp"

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

/// The clusters whose range holds a stored value.
template <class Real>
std::vector<std::uint32_t> clusters_around(const core::Packed& packed, Real stored) {
    const auto& ranges = packed.as<Real>().ranges;
    constexpr std::size_t at_once = 1 << 14;
    std::vector<std::vector<std::uint32_t>> parts((packed.clusters() + at_once - 1) / at_once);
    // Which clusters may hold it is as good as random: they are listed without a branch each.
    core::worker_each(parts.size(), 1, [&](std::size_t part) {
        std::vector<std::uint32_t> hits(at_once + 1);
        std::size_t count = 0;
        for (std::size_t c = at_once * part, end = std::min(packed.clusters(), c + at_once); c < end; ++c) {
            hits[count] = static_cast<std::uint32_t>(c);
            count += unsigned{ranges[c].lower <= stored} & unsigned{stored <= ranges[c].upper};
        }
        hits.resize(count);
        parts[part] = std::move(hits);
    });
    std::vector<std::uint32_t> all;
    for (const std::vector<std::uint32_t>& part : parts) all.insert(all.end(), part.begin(), part.end());
    return all;
}

/// Calls f(packed point) for every own point with this stored value, in parallel.
template <class Real, class F>
Result<void> for_points_with(const core::Packed& packed, Real stored, const Progress& progress, const F& f) {
    const std::vector<std::uint32_t> hits = clusters_around(packed, stored);
    const Real* const all_values = packed.as<Real>().values.data();
    const auto values_of = [&](std::size_t i) { return all_values + packed.headers[hits[i]].first_point; };
    const auto look = [&](std::size_t first, std::size_t last) -> Result<void> {
        core::worker_ranges(last - first, 128, [&](std::size_t from, std::size_t to) {
            constexpr std::size_t ahead = 8;
            for (std::size_t i = first + from; i < first + to; ++i) {
                if (i + ahead < first + to)
                    core::prefetch_bytes(values_of(i + ahead), sizeof(Real) * core::max_cluster_points / 2);
                const core::ClusterHeader& h = packed.headers[hits[i]];
                const Real* const values = values_of(i);
                unsigned any = 0; // mostly none: found without a branch a point
                for (std::size_t k = 0; k < h.own_points; ++k) any |= values[k] == stored;
                for (std::size_t k = 0; any && k < h.own_points; ++k)
                    if (values[k] == stored) f(h.first_point + k);
            }
        });
        return {};
    };
    return core::in_memory(packed, hits, core::Parts::values, progress, look);
}

} // namespace

template <class Real>
Result<void> report_ties(const core::Packed& packed, double isovalue, const core::StoredIsovalue<Real>& stored,
                         std::uint64_t tied_points, ExtractReport& report, const Progress& progress) {
    report.isovalue_stored = core::restore_value(stored.sum(), packed.storage);
    report.tied_points = tied_points;
    const bool all_exact = packed.storage.unchanged && packed.field_report.flushed == 0;
    if (!all_exact && packed.field.empty()) return {};
    const auto holds_exactly = [&](std::uint64_t point, double value) {
        if (all_exact)
            return core::restore_value(static_cast<double>(packed.as<Real>().values[point]), packed.storage) == value;
        return packed.field.visit(
            [&](auto values) { return core::equals_exactly(values[packed.user_point(point)], value); });
    };
    if (tied_points) {
        std::atomic<std::uint64_t> exact{0};
        const auto looked = for_points_with(packed, stored.tied, progress, [&](std::uint64_t point) {
            if (holds_exactly(point, isovalue)) exact.fetch_add(1, std::memory_order_relaxed);
        });
        if (!looked) return looked;
        report.false_ties = tied_points - exact;
        return {};
    }
    report.false_ties = 0;
    const double nearest = snap(packed.field, isovalue);
    const Real nearest_stored = core::store_value<Real>(nearest, packed.storage);
    if (nearest == isovalue || nearest_stored == stored.tied) return {};
    std::atomic<bool> near{false};
    const auto looked = for_points_with(packed, nearest_stored, progress, [&](std::uint64_t point) {
        if (holds_exactly(point, nearest)) near.store(true, std::memory_order_relaxed);
    });
    if (!looked) return looked;
    report.near_tie = near;
    return {};
}

template Result<void> report_ties<float>(const core::Packed&, double, const core::StoredIsovalue<float>&, std::uint64_t,
                                         ExtractReport&, const Progress&);
template Result<void> report_ties<double>(const core::Packed&, double, const core::StoredIsovalue<double>&,
                                          std::uint64_t, ExtractReport&, const Progress&);

} // namespace api
} // namespace isotet
