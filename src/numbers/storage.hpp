// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How values and coordinates are stored, so that every engine can compute with them bit for bit alike: no denormals, no
// infinities, no overflow. docs/inside/precision.md tells why each rule is there.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/pack.hpp>

namespace isotet::core {

constexpr double tiny = 0x1p-70;              ///< what is below is stored as +0
constexpr double largest_stored = 0x1p57;     ///< finite values stay at or below
constexpr double stored_infinity = 0x1p91;

/// Not-a-number by its bits: comparisons may be compiled away on some devices, integer tests are not.
inline bool is_nan(float x) { return (std::bit_cast<std::uint32_t>(x) & 0x7fffffffu) > 0x7f800000u; }
inline bool is_nan(double x) { return (std::bit_cast<std::uint64_t>(x) & 0x7fffffffffffffffu) > 0x7ff0000000000000u; }

template <class Real>
constexpr Real canonical_nan() {
    if constexpr (sizeof(Real) == 4) return std::bit_cast<float>(0x7fc00000u);
    else return std::bit_cast<double>(0x7ff8000000000000u);
}

/// How values of a field become stored values; see storage.hpp.
struct Storage {
    double offset = 0;
    double scale = 1;
    bool unchanged = true;
};

/// The stored form of one value; NaN stays NaN.
template <class Real>
Real store_value(double value, const Storage& storage) {
    if (is_nan(value)) return canonical_nan<Real>();
    if (std::isinf(value)) return static_cast<Real>(value > 0 ? stored_infinity : -stored_infinity);
    const Real stored = static_cast<Real>((value - storage.offset) * storage.scale);
    return std::abs(stored) < Real(tiny) ? Real(0) : stored; // also turns -0 into +0
}

/// The stored form of an isovalue: `value` + `rest`.
template <class Real>
struct StoredIsovalue {
    Real value;        ///< stored values that are at least this are above
    Real rest = 0;     ///< 0, or less where `value` was rounded up
    Real tied = value; ///< stored values that equal this are tied; never_stored where none can be

    static constexpr Real never_stored = static_cast<Real>(2 * stored_infinity);

    double sum() const { return static_cast<double>(value) + static_cast<double>(rest); }
};

/// Where values are stored unchanged, `value` is rounded up: a stored value is at least that just when it is at least
/// the isovalue, and equals the isovalue only if nothing was rounded. Elsewhere `value` is rounded as values are.
template <class Real>
StoredIsovalue<Real> store_isovalue(double isovalue, const Storage& storage) {
    double x = (isovalue - storage.offset) * storage.scale;
    x = std::min(std::max(x, -largest_stored), largest_stored);
    Real value = static_cast<Real>(x);
    if (storage.unchanged && static_cast<double>(value) < x)
        value = std::nextafter(value, std::numeric_limits<Real>::infinity());
    if (std::abs(value) < Real(tiny)) return {0}; // as values so small are
    if (!storage.unchanged || static_cast<double>(value) == x) return {value};
    return {value, static_cast<Real>(x - static_cast<double>(value)), StoredIsovalue<Real>::never_stored};
}

/// A stored value in the unit of the field.
inline double restore_value(double stored, const Storage& storage) { return stored / storage.scale + storage.offset; }

/// A double rounded to float32. Through memory: g++ 12 at -O3 turns two such roundings side by side into none.
inline double rounded_to_float(double x) {
    const volatile float rounded = static_cast<float>(x);
    return rounded;
}

/// The stored form of a coordinate relative to the origin.
template <class Real>
Real store_coordinate(double coordinate, double origin) {
    const Real stored = static_cast<Real>(coordinate - origin);
    return std::abs(stored) < Real(tiny) ? Real(0) : stored;
}

/// What the finite values of a field at some points are like; combine() commutes.
struct ValueStatistics {
    double lower = std::numeric_limits<double>::infinity();
    double upper = -std::numeric_limits<double>::infinity();
    std::uint64_t no_data = 0, infinite = 0;

    void add(double value) {
        if (is_nan(value)) ++no_data;
        else if (std::isinf(value)) ++infinite;
        else {
            if (value < lower) lower = value;
            if (value > upper) upper = value;
        }
    }
    void combine(const ValueStatistics& other) {
        lower = std::min(lower, other.lower);
        upper = std::max(upper, other.upper);
        no_data += other.no_data;
        infinite += other.infinite;
    }
};

/// Chooses offset and `unchanged` for a field (scale stays 1: the smallest non-zero magnitude decides on it later).
ISOTET_API Storage choose_offset(ScalarType type, const ValueStatistics& statistics, Precision precision);

/// Chooses the scale once the extreme non-zero magnitudes of (value - offset) are known (both 0 when all are 0).
ISOTET_API void choose_scale(Storage& storage, double smallest_magnitude, double largest_magnitude);

/// Compares a scalar of the user's own type with a double, exactly.
template <class T>
bool equals_exactly(T value, double wanted) {
    if constexpr (std::is_integral_v<T>) {
        // A double that is an integer inside T's range converts without loss; all others cannot be equal.
        if (!(wanted >= -0x1p63 && wanted < 0x1p64) || wanted != std::floor(wanted)) return false;
        if (wanted < 0)
            return std::is_signed_v<T> && static_cast<std::int64_t>(value) == static_cast<std::int64_t>(wanted);
        return value >= 0 && static_cast<std::uint64_t>(value) == static_cast<std::uint64_t>(wanted);
    } else {
        return static_cast<double>(value) == wanted;
    }
}

} // namespace isotet::core
