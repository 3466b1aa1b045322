// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What giving a packed grid a field is made of: values, then what follows from them. A device may work out ranges
// itself.
#pragma once

#include <cstddef>
#include <cstdint>

#include <isotet/export.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "packed/packed.hpp"

namespace isotet::core {

/// Errors   invalid_argument when the field is not one scalar for each of `points` points
ISOTET_API Result<void> check_field(const PointField& field, std::uint64_t points);

/// Stores the values of a field: values, storage and the field's report. The arrays of ranges and group ranges are new
/// and not filled, has_no_data is cleared.
/// Errors   cancelled
template <class Real>
ISOTET_API Result<void> store_values(const PointField& field, Packed& packed, const Progress& progress);

/// Works out ranges, group ranges and has_no_data of the clusters [begin, end) from the stored values. Parallel; what
/// is left when cancelled means nothing.
template <class Real>
ISOTET_API void store_ranges(Packed& packed, std::size_t begin, std::size_t end, const Progress& progress);

/// Computes the gradient direction of the stored field at every point (normal_code.hpp).
ISOTET_API void store_gradients(Packed& packed);

} // namespace isotet::core
