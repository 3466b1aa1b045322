// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "core/local_values.hpp"
#include "core/pack_draft.hpp"
#include "core/parallel.hpp"
#include "core/storage.hpp"

namespace isotet::core {

namespace {

/// The extreme non-zero magnitudes of (value - offset) over finite values.
struct Magnitudes {
    double smallest = std::numeric_limits<double>::infinity();
    double largest = 0;

    void add(double value) {
        const double magnitude = std::abs(value);
        if (!(magnitude > 0) || std::isinf(magnitude)) return; // also NaN
        smallest = std::min(smallest, magnitude);
        largest = std::max(largest, magnitude);
    }
    void combine(const Magnitudes& other) {
        smallest = std::min(smallest, other.smallest);
        largest = std::max(largest, other.largest);
    }
};

/// Reduces over the field's values at all packed points; combine() commutes, so threads do not matter.
template <class Statistics, class Add>
Statistics reduce_values(const Packed& packed, const Array& values, const Add& add) {
    return values.visit([&](auto typed) {
        return tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, packed.points(), 1 << 15), Statistics{},
            [&](const tbb::blocked_range<std::size_t>& range, Statistics partial) {
                for (std::size_t i = range.begin(); i < range.end(); ++i)
                    add(partial, static_cast<double>(typed[packed.user_point(i)]));
                return partial;
            },
            [](Statistics a, const Statistics& b) {
                a.combine(b);
                return a;
            });
    });
}

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
    const Precision precision = sizeof(Real) == 4 ? Precision::single : Precision::double_;
    const auto statistics = reduce_values<ValueStatistics>(packed, field.values, [](ValueStatistics& s, double v) { s.add(v); });
    Storage storage = choose_offset(field.values.type(), statistics, precision);
    const auto magnitudes = reduce_values<Magnitudes>(
        packed, field.values, [offset = storage.offset](Magnitudes& m, double v) { m.add(v - offset); });
    choose_scale(storage, magnitudes.smallest, magnitudes.largest);
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
                reals.values[i] = store_value<Real>(value, storage);
                count += reals.values[i] == 0 && value != storage.offset;
            }
            flushed += count;
        });
    });
    if (progress.cancelled()) return cancelled();
    parallel_each(packed.clusters(), 64, [&](std::size_t c) { store_ranges<Real>(packed, c); });

    packed.storage = storage;
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
    report.offset = storage.offset;
    report.scale = storage.scale;
    report.unchanged = storage.unchanged;
    return {};
}

template Result<void> store_values<float>(const PointField&, Packed&, const Progress&);
template Result<void> store_values<double>(const PointField&, Packed&, const Progress&);

} // namespace isotet::core
