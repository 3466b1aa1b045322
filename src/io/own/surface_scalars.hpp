// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Arrays out of bytes and out of text, with no memory taken for what cannot be there.
#pragma once

#include <bit>
#include <charconv>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/own/text_scanner.hpp"

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

/// How many bytes `tuples` x `components` scalars take; nothing if that is more than `available`.
std::optional<std::size_t> bytes_needed(ScalarType type, std::uint64_t tuples, std::uint64_t components,
                                        std::size_t available);

/// A copy of scalars that stand in `bytes` one after another; their number is a multiple of `components`.
Array decode_scalars(ScalarType type, std::string_view bytes, std::size_t components, std::endian order);

/// Exactly tuples x components numbers from the scanner.
///
/// Errors   invalid_data: the text is too short for so many, a word is no number of the type; cancelled
Result<Array> scan_scalars(TextScanner& scanner, ScalarType type, std::uint64_t tuples, std::uint64_t components,
                           std::string_view what, const Progress& progress);

/// Integers as uint64; negative ones become huge, and so fail every check against a count. Empty for floating arrays.
std::vector<std::uint64_t> as_indices(const Array& array);

} // namespace isotet::io
