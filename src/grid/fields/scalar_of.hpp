// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One scalar of each tuple: a component, or the magnitude.
#pragma once

#include <cstddef>
#include <optional>

#include <isotet/array.hpp>

namespace isotet::core {

/// Which scalar: a component, or the magnitude of all.
struct Scalar {
    std::size_t component = 0;
    bool magnitude = false;
};

/// `x`, `y`, `z`, `mag` or a number; nothing for other text or a number beyond 64 bits.
std::optional<Scalar> parse_scalar(std::string_view text);

/// The scalar of one tuple as a double. Magnitudes neither overflow nor underflow.
double scalar_at(const Array& array, Scalar scalar, std::size_t tuple);

/// The scalar of every tuple: the array itself if it is its only component; else a copy, components in their own type,
/// magnitudes float32 of float32 and float64 of all others. In parallel.
Array scalar_of(const Array& array, Scalar scalar);

} // namespace isotet::core
