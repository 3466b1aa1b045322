// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// survey_points(): ranges, magnitudes and bounds, in lanes that the compiler can turn into vectors.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "cpu/at_level.hpp"
#include "cpu/direct/points.hpp"
#include "grid/orientation.hpp"
#include "numbers/bounds.hpp"
#include "numbers/value_summary.hpp"
#include "packed/frame.hpp"

namespace isotet::cpu::direct {

namespace {

constexpr std::size_t survey_grain = 1 << 15;

/// Of all values of the points [begin, end) that count.
template <class T>
core::ValueSummary summarize(std::span<const T> values, std::size_t components, const Sides* seen, std::size_t begin,
                             std::size_t end, double offset) {
    using Number = std::conditional_t<std::is_same_v<T, float>, float, double>; // floats have no offset
    core::ValueSummary summary;
    if (seen) {
        for (std::size_t point = begin; point < end; ++point)
            for (std::size_t k = 0; k < components && !seen->is_unseen(point); ++k)
                summary.add(static_cast<double>(values[point * components + k]), offset);
        return summary;
    }
    core::SummaryLanes<Number> lanes;
    std::size_t i = begin * components;
    for (; i + lanes.count <= end * components; i += lanes.count) {
        typename core::SummaryLanes<Number>::Values some;
        for (std::size_t k = 0; k < lanes.count; ++k) some[k] = static_cast<Number>(values[i + k]);
        lanes.add(some, static_cast<Number>(offset));
    }
    for (; i < end * components; ++i) summary.add(static_cast<double>(values[i]), offset);
    summary.combine(lanes.summary());
    return summary;
}

core::ValueSummary summarize(const Array& values, const Sides* seen, double offset) {
    return values.visit([&]<class T>(std::span<const T> typed) {
        return tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, values.tuples(), survey_grain), core::ValueSummary{},
            [&](const tbb::blocked_range<std::size_t>& range, core::ValueSummary summary) {
                at_level([&] {
                    summary.combine(summarize(typed, values.components(), seen, range.begin(), range.end(), offset));
                });
                return summary;
            },
            [](core::ValueSummary a, const core::ValueSummary& b) {
                a.combine(b);
                return a;
            });
    });
}

/// Stored values that are 0 though the values are not.
template <class Real>
std::uint64_t count_flushed(const Array& values, const Sides* seen, const core::Storage& storage) {
    return values.visit([&](auto typed) {
        return tbb::parallel_reduce(
            tbb::blocked_range<std::size_t>(0, values.tuples(), survey_grain), std::uint64_t{0},
            [&](const tbb::blocked_range<std::size_t>& range, std::uint64_t count) {
                for (std::size_t point = range.begin(); point < range.end(); ++point) {
                    const auto value = static_cast<double>(typed[point]);
                    count += core::store_value<Real>(value, storage) == 0 && value != storage.offset &&
                             !(seen && seen->is_unseen(point));
                }
                return count;
            },
            std::plus<>());
    });
}

/// `framed`   null, or what the frame knows of the field
StoredField survey_field(const Array& values, const Sides* seen, Precision precision, const FieldSurvey* framed) {
    core::ValueSummary summary = summarize(values, seen, 0);
    StoredField out{summary.statistics, core::choose_offset(values.type(), summary.statistics, precision), 0};
    if (framed) out.storage = core::storage_in(*framed, precision);
    if (out.storage.offset != 0) summary = summarize(values, seen, out.storage.offset);
    if (!framed) core::choose_scale(out.storage, summary.smallest, summary.largest);
    out.smallest = summary.smallest * out.storage.scale;
    return out;
}

/// One that the frame does not know, or whose values it does not hold, is stored as without it.
StoredField survey_carried(const Field& field, const Sides* seen, Precision precision, const Frame* frame) {
    const FieldSurvey* const framed = frame ? frame->find(field.name) : nullptr;
    if (!framed || framed->type != field.values.type()) return survey_field(field.values, seen, precision, nullptr);
    const StoredField stored = survey_field(field.values, seen, precision, framed);
    return core::check_range(*framed, field.name, stored.statistics)
               ? stored
               : survey_field(field.values, seen, precision, nullptr);
}

/// Bounds of sound points, and whether there are others.
struct Bounds : core::Bounds {
    bool has_unsound = false;

    void combine(const Bounds& other) {
        core::Bounds::combine(other);
        has_unsound |= other.has_unsound;
    }
};

template <class T>
bool all_are_sound(const T* coordinates, std::size_t count) {
    // Magnitudes are ordered as the bits are, NaN comes last, and a difference that is negative has its highest bit set.
    using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;
    constexpr Bits magnitude = std::numeric_limits<Bits>::max() >> 1;
    constexpr Bits most = std::bit_cast<Bits>(static_cast<T>(0x1p91)) - 1;
    Bits differences = 0;
    for (std::size_t i = 0; i < count; ++i) differences |= most - (std::bit_cast<Bits>(coordinates[i]) & magnitude);
    return differences <= magnitude;
}

/// `wanted`: bounds, not only soundness.
Bounds bounds_of(const Array& array, const Sides* seen, bool wanted) {
    const core::PointReader points(array);
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, array.tuples(), survey_grain), Bounds{},
        [&](const tbb::blocked_range<std::size_t>& range, Bounds bounds) {
            bool sound = true;
            at_level([&] {
                sound = array.type() == ScalarType::float32
                            ? all_are_sound(array.as<float>().data() + 3 * range.begin(), 3 * range.size())
                            : all_are_sound(array.as<double>().data() + 3 * range.begin(), 3 * range.size());
            });
            bounds.has_unsound |= !sound;
            for (std::size_t point = range.begin(); wanted && point < range.end(); ++point)
                if (!(seen && seen->is_unseen(point)) && (sound || is_sound(points[point]))) bounds.add(points[point]);
            return bounds;
        },
        [](Bounds a, const Bounds& b) {
            a.combine(b);
            return a;
        });
}

} // namespace

template <class Real>
PointSurvey survey_points(const ops::DirectInput& input, const Sides* seen) {
    constexpr Precision precision = sizeof(Real) == sizeof(float) ? Precision::float32 : Precision::float64;
    PointSurvey out;
    out.framed = input.frame != nullptr;
    out.field =
        survey_field(input.field.values, seen, precision, input.frame ? input.frame->find(input.field.name) : nullptr);
    if (out.field.may_flush()) out.flushed = count_flushed<Real>(input.field.values, seen, out.field.storage);
    for (const Field& field : input.carried) out.carried.push_back(survey_carried(field, seen, precision, input.frame));

    const Array& points = input.grid.points;
    out.rounds_coordinates = points.type() == ScalarType::float64 && precision == Precision::float32;
    const Bounds bounds = bounds_of(points, seen, out.rounds_coordinates);
    out.has_unsound = bounds.has_unsound;
    out.lower = bounds.lower; // above upper where there are no points
    out.upper = bounds.upper;
    if (out.rounds_coordinates && bounds.lower[0] <= bounds.upper[0]) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            out.origin[axis] =
                core::rounded_to_float(bounds.lower[axis] + (bounds.upper[axis] - bounds.lower[axis]) / 2);
        if (input.frame) out.origin = core::origin_in(input.frame->whole);
    }
    return out;
}

template PointSurvey survey_points<float>(const ops::DirectInput&, const Sides*);
template PointSurvey survey_points<double>(const ops::DirectInput&, const Sides*);

namespace {

bool same_storage(const core::Storage& a, const core::Storage& b) {
    return a.offset == b.offset && a.scale == b.scale && a.unchanged == b.unchanged;
}

} // namespace

bool PointSurvey::decides_as(const PointSurvey& other) const {
    return same_storage(field.storage, other.field.storage) && field.statistics.lower == other.field.statistics.lower &&
           field.statistics.upper == other.field.statistics.upper && origin == other.origin &&
           (!framed || (lower == other.lower && upper == other.upper)) &&
           std::equal(carried.begin(), carried.end(), other.carried.begin(),
                      [](const StoredField& a, const StoredField& b) { return same_storage(a.storage, b.storage); });
}

FieldReport PointSurvey::report(const std::string& name) const {
    FieldReport report;
    report.name = name;
    report.lower = field.statistics.lower;
    report.upper = field.statistics.upper;
    report.no_data = field.statistics.no_data;
    report.infinite = field.statistics.infinite;
    report.flushed = flushed;
    report.offset = field.storage.offset;
    report.scale = field.storage.scale;
    report.unchanged = field.storage.unchanged;
    return report;
}

} // namespace isotet::cpu::direct
