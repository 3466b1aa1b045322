// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/field_storage.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <type_traits>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "core/value_summary.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t grain = 1 << 15;

/// A pass over values at packed points.
struct Pass {
    ValueSummary summary;
    std::uint64_t flushed = 0;

    void combine(const Pass& other) {
        summary.combine(other.summary);
        flushed += other.flushed;
    }
};

/// store_value() of finite values side by side. Returns how many were flushed.
template <class Real, class Number>
std::uint64_t store_lanes(const typename SummaryLanes<Number>::Values& values, const Storage& storage, Real* out) {
    const Number offset = static_cast<Number>(storage.offset), scale = static_cast<Number>(storage.scale);
    std::uint32_t flushed = 0;
    for (std::size_t k = 0; k < values.size(); ++k) {
        const Real scaled = static_cast<Real>((values[k] - offset) * scale);
        const Real stored = std::abs(scaled) < Real(tiny) ? Real(0) : scaled;
        flushed += std::uint32_t{stored == 0} & std::uint32_t{values[k] != offset};
        out[k] = stored;
    }
    return flushed;
}

/// Looks at the values of `ids` and, unless `out` is null, stores them.
template <class Number, class Real, class T, class Id>
Pass pass_over(std::span<const T> values, std::size_t components, std::span<const Id> ids, const Storage& storage,
               Real* out) {
    constexpr std::size_t lanes = SummaryLanes<Number>::count;
    Pass pass;
    const auto one = [&](std::size_t i, std::size_t component) {
        const double value = static_cast<double>(values[ids[i] * components + component]);
        pass.summary.add(value, storage.offset);
        if (!out) return;
        out[i] = store_value<Real>(value, storage);
        pass.flushed += out[i] == 0 && value != storage.offset;
    };
    std::size_t i = 0;
    if (components == 1) {
        SummaryLanes<Number> summary;
        for (; i + lanes <= ids.size(); i += lanes) {
            typename SummaryLanes<Number>::Values some;
            for (std::size_t k = 0; k < lanes; ++k) some[k] = static_cast<Number>(values[ids[i + k]]);
            const bool finite = summary.add(some, static_cast<Number>(storage.offset));
            if (!out) continue;
            pass.flushed += store_lanes<Real, Number>(some, storage, out + i);
            if (!finite) // what was made of infinities and NaN is wrong, but counted rightly: not as flushed
                for (std::size_t k = 0; k < lanes; ++k)
                    out[i + k] = store_value<Real>(static_cast<double>(some[k]), storage);
        }
        pass.summary.combine(summary.summary());
    }
    for (; i < ids.size(); ++i)
        for (std::size_t k = 0; k < components; ++k) one(i, k);
    return pass;
}

/// `out` may be null: then values are only looked at, and may have several components.
template <class Real>
Pass pass_over(const Array& values, const Packed& packed, const Storage& storage, const Progress& progress, Real* out) {
    const std::size_t components = values.components();
    return values.visit([&]<class T>(std::span<const T> typed) {
        const auto of = [&](auto number, auto ids) {
            return tbb::parallel_reduce(
                tbb::blocked_range<std::size_t>(0, ids.size(), grain), Pass{},
                [&](const tbb::blocked_range<std::size_t>& range, Pass pass) {
                    if (progress.cancelled()) return pass;
                    pass.combine(pass_over<decltype(number)>(typed, components,
                                                             ids.subspan(range.begin(), range.size()), storage,
                                                             out ? out + range.begin() : out));
                    return pass;
                },
                [](Pass a, const Pass& b) {
                    a.combine(b);
                    return a;
                });
        };
        const auto with = [&](auto number) {
            if (packed.wide_point_ids.empty())
                return of(number, std::span(packed.point_ids.data(), packed.point_ids.size()));
            return of(number, std::span(packed.wide_point_ids.data(), packed.wide_point_ids.size()));
        };
        // Floats that are not scaled need no double.
        if constexpr (std::is_same_v<T, float> && std::is_same_v<Real, float>)
            if (storage.offset == 0 && storage.scale == 1) return with(float{});
        return with(double{});
    });
}

/// Tries offset 0 and scale 1, which are mostly right, and passes over the values again when they are not.
template <class Real>
FieldStorage choose_and_store(const Array& values, const Packed& packed, const Progress& progress, Real* out) {
    const Precision precision = packed.single() ? Precision::single : Precision::double_;
    Storage tried;
    for (;;) {
        const Pass pass = pass_over(values, packed, tried, progress, out);
        Storage chosen = choose_offset(values.type(), pass.summary.statistics, precision);
        const bool same_offset = chosen.offset == tried.offset;
        if (same_offset) choose_scale(chosen, pass.summary.smallest, pass.summary.largest);
        if (progress.cancelled() || (same_offset && (chosen.scale == tried.scale || !out)))
            return {chosen, pass.summary.statistics, pass.flushed};
        tried = chosen;
    }
}

} // namespace

template <class Real>
FieldStorage store_field_values(const Array& values, const Packed& packed, const Progress& progress, Real* out) {
    return choose_and_store(values, packed, progress, out);
}

template FieldStorage store_field_values<float>(const Array&, const Packed&, const Progress&, float*);
template FieldStorage store_field_values<double>(const Array&, const Packed&, const Progress&, double*);

std::optional<Storage> StorageCache::find(const Array& values) const {
    const std::lock_guard lock(mutex_);
    for (const Entry& entry : entries_)
        if (entry.array.is(values)) return entry.storage;
    return {};
}

void StorageCache::add(const Array& values, const Storage& storage) {
    const ArrayIdentity array(values);
    if (array.expired()) return;
    const std::lock_guard lock(mutex_);
    std::erase_if(entries_, [](const Entry& entry) { return entry.array.expired(); });
    entries_.push_back({array, storage});
}

Storage choose_storage(const Array& values, const Packed& packed) {
    if (const auto known = packed.storage_cache->find(values)) return *known;
    const Storage storage = packed.single() ? choose_and_store<float>(values, packed, {}, nullptr).storage
                                            : choose_and_store<double>(values, packed, {}, nullptr).storage;
    packed.storage_cache->add(values, storage);
    return storage;
}

} // namespace isotet::core
