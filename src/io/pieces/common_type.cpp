// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/common_type.hpp"

#include <algorithm>
#include <limits>

#include "base/parallel.hpp"
#include "io/files/scalars.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t scalars_at_once = std::size_t{1} << 16;

bool is_signed(ScalarType type) noexcept {
    return type == ScalarType::int8 || type == ScalarType::int16 || type == ScalarType::int32 ||
           type == ScalarType::int64;
}

} // namespace

ScalarType common_type(ScalarType a, ScalarType b) noexcept {
    if (a == b) return a;
    if (is_floating(a) || is_floating(b)) return ScalarType::float64;
    if (is_signed(a) == is_signed(b)) return size_of(a) > size_of(b) ? a : b;
    const std::size_t of_signed = size_of(is_signed(a) ? a : b), of_unsigned = size_of(is_signed(a) ? b : a);
    switch (std::max(of_signed, 2 * of_unsigned)) {
    case 2: return ScalarType::int16;
    case 4: return ScalarType::int32;
    case 8: return ScalarType::int64;
    default: return ScalarType::float64;
    }
}

void convert_scalars(const Array& from, ScalarType type, std::byte* to) {
    with_type(type, [&](auto zero) {
        using To = decltype(zero);
        auto* const values = reinterpret_cast<To*>(to);
        from.visit([&](auto scalars) {
            core::parallel_each(scalars.size(), scalars_at_once,
                                [&](std::size_t i) { values[i] = static_cast<To>(scalars[i]); });
        });
    });
}

void fill_missing(ScalarType type, std::size_t count, std::byte* to) {
    with_type(type, [&](auto zero) {
        using Scalar = decltype(zero);
        Scalar missing{};
        if constexpr (std::numeric_limits<Scalar>::has_quiet_NaN)
            missing = std::numeric_limits<Scalar>::quiet_NaN();
        std::fill_n(reinterpret_cast<Scalar*>(to), count, missing);
    });
}

} // namespace isotet::io
