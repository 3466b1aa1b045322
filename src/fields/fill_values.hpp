// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Numbers that stand for no value, as files have them in place of NaN: -9999, 1e20, 9.96921e36.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/fields.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::core {

struct FillValue {
    double value = 0;
    std::uint64_t count = 0; ///< of the values that are it
};

struct FillValues {
    std::vector<FillValue> values; ///< ascending; empty: there is none
    ValueRange others;             ///< of all other finite values
};

/// Numbers that programs write where there is no value, if all others are far from them: -999.25 (logs of wells), -999,
/// -9999 and so on, 9999 and so on, and the ends of integers, farther away than the others are from each other; and 1e20
/// and above, of either sign, a million times as far. None where the others are all one, or there are more than four such
/// numbers.
///
/// `values`   of one component, else nothing is looked for
/// Cost       a pass over the values; where an end of their range is such a number another
/// Errors     as statistics_of()
ISOTET_API Result<FillValues> find_fill_values(const Array& values, const Run& run = {});

/// The same where the range of the finite values is known.
ISOTET_API FillValues fill_values_of(const Array& values, const ValueRange& range);

/// The same of finite numbers, ascending.
FillValues fill_values_of(std::span<const double> ascending);

} // namespace isotet::core
