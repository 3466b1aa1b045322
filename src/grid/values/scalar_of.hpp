// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One scalar of each tuple: a component, or the magnitude.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>

#include <isotet/array.hpp>
#include <isotet/export.hpp>

namespace isotet::core {

/// Which scalar: a component, or the magnitude of all.
struct Scalar {
    std::size_t component = 0;
    bool magnitude = false;
    bool of_tensor = false; ///< `component` is one of 9, row by row

    /// The component of a tuple of so many; nothing where it has no such. Symmetric tensors have 6: XX YY ZZ XY YZ XZ.
    ISOTET_API std::optional<std::size_t> place_in(std::size_t components) const;
};

/// `x`, `y`, `z`, `mag`, a number, of tensors `xx`, `XX` and so on; as solvers call them, capitals and an axis or a number
/// from 1: `DX`, `D1`, `SXX`, `S11`. Nothing for other text or a number beyond 64 bits.
std::optional<Scalar> parse_scalar(std::string_view text);

/// The length of a tuple. Neither overflows nor underflows.
template <class Value>
double magnitude_of(const Value* tuple, std::size_t components) {
    double largest = 0, sum = 0;
    for (std::size_t c = 0; c < components; ++c) {
        const double x = static_cast<double>(tuple[c]);
        largest = std::max(largest, std::abs(x));
        sum += x * x;
    }
    if ((largest < 0x1p500 && largest > 0x1p-500) || !(largest > 0) || std::isinf(largest)) return std::sqrt(sum);
    const int exponent = std::ilogb(largest);
    sum = 0;
    for (std::size_t c = 0; c < components; ++c) {
        const double x = std::scalbn(static_cast<double>(tuple[c]), -exponent);
        sum += x * x;
    }
    return std::scalbn(std::sqrt(sum), exponent);
}

/// The scalar of one tuple as a double. Magnitudes neither overflow nor underflow.
ISOTET_API double scalar_at(const Array& array, Scalar scalar, std::size_t tuple);

/// The scalar of every tuple: the array itself if it is its only component; else a copy, components in their own type,
/// magnitudes float32 of float32 and float64 of all others. In parallel.
Array scalar_of(const Array& array, Scalar scalar);

} // namespace isotet::core
