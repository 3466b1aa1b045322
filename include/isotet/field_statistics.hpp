// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the values of a field are like, before anything is contoured: ranges and missing values.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// One component of a field.
struct ComponentStatistics {
    double lower = 0, upper = 0;    ///< of the finite values; lower > upper when there is none
    std::uint64_t not_a_number = 0; ///< values that are NaN
    std::uint64_t infinite = 0;
};

/// Ranges and missing values of an array, one entry for each component.
///
/// Guarantees   the same for any thread count
/// Cost         one parallel pass
/// Errors       cancelled; out_of_memory
/// Threads      safe from many threads on one array
ISOTET_API Result<std::vector<ComponentStatistics>> statistics_of(const Array& values, const Run& run = {});

/// Two ends of a range; lower > upper: there is no value.
struct ValueRange {
    double lower = 1, upper = 0;
};

/// The range of a field without its rare values: the lowest and the highest fiftieth of the values do not count, unless
/// nothing but one value is left then. Not finite values are passed over; vectors count by their magnitude.
///
/// Cost   up to 200,000 values, spread evenly, are sorted
ISOTET_API ValueRange typical_range(const Array& values);

} // namespace isotet
