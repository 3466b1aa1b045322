// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which numbers stand for no value.
#pragma once

#include <cstdint>
#include <map>
#include <span>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::core {

/// Numbers that programs write where there is no value, if all others are far from them: -999.25 (logs of wells), -999,
/// -9999 and so on, 9999 and so on, and the ends of integers, farther away than the others are from each other; and 1e20
/// and above, of either sign, a million times as far. None where the others are all one, or there are more than four such
/// numbers. Of values that come in parts.
class ISOTET_API FillFinder {
public:
    /// `values`   of one component, else they do not count
    /// Cost       a pass over the values; where an end of their range is such a number another
    /// Errors     as statistics_of()
    Result<void> add(const Array& values, const Run& run = {});
    /// `range`   of the finite ones
    void add(const Array& values, const ValueRange& range);
    void add(std::span<const double> finite);

    FillValues find() const;

private:
    template <class Numbers>
    void add_each(const Numbers& numbers);

    std::map<double, std::uint64_t> counts_; ///< of such numbers
    ValueRange others_, range_;
    std::uint64_t values_ = 0;
};

ISOTET_API Result<FillValues> find_fill_values(const Array& values, const Run& run = {});
/// Of the cells, where these were averaged.
ISOTET_API Result<FillValues> find_fill_values(const PointField& field, const Run& run = {});

FillValues fill_values_of(std::span<const double> finite);

/// typical_range() within that of the cells without fill values, where these were averaged.
ISOTET_API ValueRange typical_range_of(const PointField& field);

} // namespace isotet::core
