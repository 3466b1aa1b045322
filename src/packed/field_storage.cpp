// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed/field_storage.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <type_traits>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "numbers/value_summary.hpp"
#include "packed/frame.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t grain = 1 << 15;
constexpr std::size_t block = 1 << 10; // values that are looked at together

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

/// Values of packed points from `begin` on, one after another, into `out`: the only part that depends on their type.
template <class Number>
void gather(const Array& values, const Packed& packed, std::size_t begin, std::span<Number> out) {
    const std::size_t components = values.components();
    const auto with = [&](auto typed, const auto* ids) {
        if (components == 1) {
            for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<Number>(typed[ids[i]]);
            return;
        }
        for (std::size_t i = 0; i < out.size(); i += components, ++ids)
            for (std::size_t k = 0; k < components; ++k) out[i + k] = static_cast<Number>(typed[*ids * components + k]);
    };
    const auto from = [&](auto typed) {
        if (packed.wide_point_ids.empty()) with(typed, packed.point_ids.data() + begin);
        else with(typed, packed.wide_point_ids.data() + begin);
    };
    if constexpr (std::is_same_v<Number, float>) from(values.as<float>());
    else values.visit(from);
}

/// Looks at the values of the packed points [begin, end) and, unless `out` is null, stores them. Number: double, or
/// float for float32 values that are not scaled.
template <class Number, class Real>
Pass pass_over(const Array& values, const Packed& packed, std::size_t begin, std::size_t end, const Storage& storage,
               Real* out) {
    constexpr std::size_t lanes = SummaryLanes<Number>::count;
    const std::size_t components = values.components();
    const std::size_t points_at_once = std::max(block / std::max(components, std::size_t{1}), std::size_t{1});
    std::vector<Number> gathered(points_at_once * components);
    const bool in_lanes = out || std::is_same_v<Number, float>; // doubles are looked at faster one by one
    SummaryLanes<Number> summary;
    Pass pass;
    for (; begin < end; begin += points_at_once) {
        const auto some = std::span(gathered).first(std::min(points_at_once, end - begin) * components);
        gather(values, packed, begin, some);
        std::size_t i = 0;
        for (; in_lanes && i + lanes <= some.size(); i += lanes) {
            typename SummaryLanes<Number>::Values side_by_side;
            std::copy_n(some.begin() + i, lanes, side_by_side.begin());
            const bool finite = summary.add(side_by_side, static_cast<Number>(storage.offset));
            if (!out) continue;
            pass.flushed += store_lanes<Real, Number>(side_by_side, storage, out + begin + i);
            if (!finite) // what was made of infinities and NaN is wrong, but counted rightly: not as flushed
                for (std::size_t k = i; k < i + lanes; ++k)
                    out[begin + k] = store_value<Real>(static_cast<double>(some[k]), storage);
        }
        for (; i < some.size(); ++i) {
            const auto value = static_cast<double>(some[i]);
            pass.summary.add(value, storage.offset);
            if (!out) continue;
            out[begin + i] = store_value<Real>(value, storage);
            pass.flushed += out[begin + i] == 0 && value != storage.offset;
        }
    }
    pass.summary.combine(summary.summary());
    return pass;
}

/// `out` may be null: then values are only looked at, and may have several components.
template <class Real>
Pass pass_over(const Array& values, const Packed& packed, const Storage& storage, const Progress& progress, Real* out) {
    const auto with = [&](auto number) {
        return tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, packed.points(), grain), Pass{},
            [&](const tbb::blocked_range<std::size_t>& range, Pass pass) {
                if (progress.cancelled()) return pass;
                pass.combine(pass_over<decltype(number)>(values, packed, range.begin(), range.end(), storage, out));
                return pass;
            },
            [](Pass a, const Pass& b) {
                a.combine(b);
                return a;
            });
    };
    // Floats that are not scaled need no double.
    if constexpr (std::is_same_v<Real, float>)
        if (values.type() == ScalarType::float32 && storage.offset == 0 && storage.scale == 1) return with(float{});
    return with(double{});
}

/// Tries offset 0 and scale 1, which are mostly right, and passes over the values again when they are not.
template <class Real>
FieldStorage choose_and_store(const Array& values, const Packed& packed, const Progress& progress, Real* out) {
    const Precision precision = packed.single() ? Precision::float32 : Precision::float64;
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
FieldStorage store_field_values(const Array& values, const Packed& packed, const Progress& progress, Real* out,
                                const Storage* chosen) {
    if (!chosen) return choose_and_store(values, packed, progress, out);
    const Pass pass = pass_over(values, packed, *chosen, progress, out);
    return {*chosen, pass.summary.statistics, pass.flushed};
}

template FieldStorage store_field_values<float>(const Array&, const Packed&, const Progress&, float*, const Storage*);
template FieldStorage store_field_values<double>(const Array&, const Packed&, const Progress&, double*, const Storage*);

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

namespace {

Storage choose_storage(const Array& values, const Packed& packed, const FieldSurvey* framed) {
    if (const auto known = packed.storage_cache->find(values)) return *known;
    const FieldStorage local = packed.single() ? choose_and_store<float>(values, packed, {}, nullptr)
                                               : choose_and_store<double>(values, packed, {}, nullptr);
    const bool fits = framed && framed->type == values.type() && check_range(*framed, "", local.statistics);
    const Precision precision = packed.single() ? Precision::float32 : Precision::float64;
    const Storage storage = fits ? storage_in(*framed, precision) : local.storage;
    packed.storage_cache->add(values, storage);
    return storage;
}

} // namespace

Storage choose_storage(const Array& values, const Packed& packed) { return choose_storage(values, packed, nullptr); }

Storage choose_storage(const Field& field, const Packed& packed) {
    return choose_storage(field.values, packed, packed.frame ? packed.frame->find(field.name) : nullptr);
}

} // namespace isotet::core
