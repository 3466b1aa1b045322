// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>

#include "core/field_storage.hpp"
#include "core/local_values.hpp"
#include "core/pack_draft.hpp"
#include "core/parallel.hpp"
#include "core/storage.hpp"

namespace isotet::core {

namespace {

template <class Real>
void extend(Range<Real>& range, Real value) {
    if (is_nan(value)) return;
    range.lower = std::min(range.lower, value);
    range.upper = std::max(range.upper, value);
}

/// Ranges of a cluster and its groups, from the stored values of its local points.
template <class Real>
void store_ranges(Packed& packed, std::size_t cluster) {
    constexpr Range<Real> empty{std::numeric_limits<Real>::max(), std::numeric_limits<Real>::lowest()};
    Real values[max_cluster_points];
    const std::size_t count = load_values(packed, cluster, values);
    Range<Real> whole = empty;
    bool no_data = false;
    for (std::size_t k = 0; k < count; ++k) {
        extend(whole, values[k]);
        no_data |= is_nan(values[k]);
    }
    packed.as<Real>().ranges[cluster] = whole;
    packed.has_no_data[cluster] = no_data;
    std::uint8_t steps[max_cluster_points];
    for (std::size_t k = 0; k < count; ++k) steps[k] = is_nan(values[k]) ? 0 : quantize(values[k], whole);
    const auto tets = packed.cluster_tets(cluster);
    GroupRange* groups = packed.group_ranges.data() + packed.headers[cluster].first_group;
    for (std::size_t begin = 0; begin < tets.size(); begin += group_size) {
        GroupRange range{255, 0};
        for (const StoredTet& tet : tets.subspan(begin, std::min(group_size, tets.size() - begin)))
            for (const std::uint8_t corner : tet.corners) {
                if (no_data && is_nan(values[corner])) continue;
                range.lower = std::min(range.lower, steps[corner]);
                range.upper = std::max(range.upper, steps[corner]);
            }
        *groups++ = range;
    }
}

} // namespace

template <class Real>
Result<void> store_values(const PointField& field, Packed& packed, const Progress& progress) {
    const auto cancelled = [] { return Error{ErrorCode::cancelled, "storing the field was cancelled"}; };
    const FieldStorage survey = survey_field(field.values, packed);
    const Storage chosen = survey.storage;
    const ValueStatistics& statistics = survey.statistics;
    if (progress.cancelled()) return cancelled();

    Values<Real>& reals = packed.as<Real>();
    if (reals.values.size() != packed.points()) {
        reals.values = Buffer<Real>(packed.points());
        reals.ranges = Buffer<Range<Real>>(packed.clusters());
        packed.group_ranges = Buffer<GroupRange>(packed.tets.size() / group_size);
        packed.has_no_data = Buffer<std::uint8_t>(packed.clusters());
    }
    std::atomic<std::uint64_t> flushed{0};
    field.values.visit([&](auto typed) {
        parallel_ranges(packed.points(), 1 << 15, [&](std::size_t begin, std::size_t end) {
            std::uint64_t count = 0;
            for (std::size_t i = begin; i < end; ++i) {
                const auto value = static_cast<double>(typed[packed.user_point(i)]);
                reals.values[i] = store_value<Real>(value, chosen);
                count += reals.values[i] == 0 && value != chosen.offset;
            }
            flushed += count;
        });
    });
    if (progress.cancelled()) return cancelled();
    parallel_each(packed.clusters(), 64, [&](std::size_t c) { store_ranges<Real>(packed, c); });

    packed.storage = chosen;
    packed.field = field.values;
    FieldReport& report = packed.field_report;
    report = {};
    report.name = field.name;
    if (statistics.lower <= statistics.upper) {
        report.lower = statistics.lower;
        report.upper = statistics.upper;
    }
    report.no_data = statistics.no_data;
    report.infinite = statistics.infinite;
    report.flushed = flushed;
    report.offset = chosen.offset;
    report.scale = chosen.scale;
    report.unchanged = chosen.unchanged;
    return {};
}

template Result<void> store_values<float>(const PointField&, Packed&, const Progress&);
template Result<void> store_values<double>(const PointField&, Packed&, const Progress&);

} // namespace isotet::core
