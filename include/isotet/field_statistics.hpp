// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the values of a field are like, before anything is contoured: ranges, missing values, and which field to show.
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

/// A field to begin with.
struct DefaultField {
    std::string name;           ///< for find_field(), "velocity:mag" of a vector; empty: none has two different values
    bool whole_numbers = false; ///< it numbers something, regions say, more likely than it was measured
};

/// The field to show where none was named: the one whose values are spread most evenly over its range, by the entropy
/// of a histogram of 64 bins. Scalars and vectors of three components are judged, vectors by their magnitude. Fields of
/// whole numbers count only where no other field has two different values; missing values count against a field.
///
/// Cost   up to 200,000 values of each field are looked at
ISOTET_API DefaultField default_field(const Grid& grid);

} // namespace isotet
