// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Numbers of a type that only the file knows.
#pragma once

#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <isotet/array.hpp>

#include "io/files/text_scanner.hpp"

namespace isotet::io {

/// Calls `f` with a zero of the C++ type.
template <class F>
decltype(auto) with_type(ScalarType type, F&& f) {
    switch (type) {
    case ScalarType::int8: return f(std::int8_t{});
    case ScalarType::uint8: return f(std::uint8_t{});
    case ScalarType::int16: return f(std::int16_t{});
    case ScalarType::uint16: return f(std::uint16_t{});
    case ScalarType::int32: return f(std::int32_t{});
    case ScalarType::uint32: return f(std::uint32_t{});
    case ScalarType::int64: return f(std::int64_t{});
    case ScalarType::uint64: return f(std::uint64_t{});
    case ScalarType::float32: return f(float{});
    case ScalarType::float64: break;
    }
    return f(double{});
}

/// Rounded; infinite where float32 ends.
inline float to_float(double value) noexcept {
    constexpr double largest = std::numeric_limits<float>::max();
    if (value > largest) return std::numeric_limits<float>::infinity();
    if (value < -largest) return -std::numeric_limits<float>::infinity();
    return static_cast<float>(value);
}

/// The next number of the text as a T: float32 is rounded once. Integers out of range are none.
template <class T>
bool read_scalar(TextScanner& scanner, T& value) {
    if constexpr (std::same_as<T, float>) {
        if (scanner.at_end()) return false;
        const auto rest = scanner.rest();
        const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
        const auto used = static_cast<std::size_t>(end - rest.data());
        if (error == std::errc{} && (used == rest.size() || is_space(rest[used]))) {
            scanner.seek(scanner.position() + used);
            return true;
        }
        double wide = 0;
        if (!scanner.number(wide)) return false;
        value = to_float(wide);
        return true;
    } else {
        return scanner.number(value);
    }
}

/// Integers as uint64; negative ones become huge, and so fail every check against a count. Empty for floating arrays.
std::vector<std::uint64_t> as_indices(const Array& array);

} // namespace isotet::io
