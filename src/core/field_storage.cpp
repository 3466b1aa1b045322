// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/field_storage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

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

/// Reduces over the values at all packed points; combine() commutes, so threads do not matter.
template <class Statistics, class Add>
Statistics reduce_values(const Packed& packed, const Array& values, const Add& add) {
    const std::size_t components = values.components();
    return values.visit([&](auto typed) {
        return tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, packed.points(), 1 << 15), Statistics{},
            [&](const tbb::blocked_range<std::size_t>& range, Statistics partial) {
                for (std::size_t i = range.begin(); i < range.end(); ++i)
                    for (std::size_t k = 0; k < components; ++k)
                        add(partial, static_cast<double>(typed[packed.user_point(i) * components + k]));
                return partial;
            },
            [](Statistics a, const Statistics& b) {
                a.combine(b);
                return a;
            });
    });
}

} // namespace

FieldStorage survey_field(const Array& values, const Packed& packed) {
    FieldStorage out;
    out.statistics = reduce_values<ValueStatistics>(packed, values, [](ValueStatistics& s, double v) { s.add(v); });
    out.storage = choose_offset(values.type(), out.statistics, packed.single() ? Precision::single : Precision::double_);
    const auto magnitudes =
        reduce_values<Magnitudes>(packed, values, [offset = out.storage.offset](Magnitudes& m, double v) { m.add(v - offset); });
    choose_scale(out.storage, magnitudes.smallest, magnitudes.largest);
    return out;
}

std::optional<Storage> StorageCache::find(const Array& values) const {
    const std::lock_guard lock(mutex_);
    for (const Entry& entry : entries_)
        if (!entry.owner.expired() && entry.data == values.data() && entry.tuples == values.tuples() &&
            entry.components == values.components() && entry.type == values.type())
            return entry.storage;
    return {};
}

void StorageCache::add(const Array& values, const Storage& storage) {
    if (values.owner().expired()) return;
    const std::lock_guard lock(mutex_);
    std::erase_if(entries_, [](const Entry& entry) { return entry.owner.expired(); });
    entries_.push_back({values.owner(), values.data(), values.tuples(), values.components(), values.type(), storage});
}

Storage choose_storage(const Array& values, const Packed& packed) {
    if (const auto known = packed.storage_cache->find(values)) return *known;
    const Storage storage = survey_field(values, packed).storage;
    packed.storage_cache->add(values, storage);
    return storage;
}

} // namespace isotet::core
