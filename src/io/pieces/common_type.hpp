// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One type for the values of several arrays.
#pragma once

#include <cstddef>

#include <isotet/array.hpp>
#include <isotet/export.hpp>

namespace isotet::io {

/// The type that holds the values of both: the smallest integer type that does, else float64.
ISOTET_API ScalarType common_type(ScalarType a, ScalarType b) noexcept;

/// The type where some tuples have no value: integers have no NaN.
inline ScalarType with_missing(ScalarType type) noexcept { return is_floating(type) ? type : ScalarType::float64; }

/// Writes the scalars of `from` as scalars of a type that common_type() or with_missing() gave. On all threads.
void convert_scalars(const Array& from, ScalarType type, std::byte* to);

/// Fills `count` scalars with NaN; integers with 0.
void fill_missing(ScalarType type, std::size_t count, std::byte* to);

} // namespace isotet::io
