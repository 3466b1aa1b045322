// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the choice of a field's storage depends on, value by value, or in lanes that the compiler can turn into vectors.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "numbers/storage.hpp"

namespace isotet::core {

/// Values of a field at some points; combine() commutes.
struct ValueSummary {
    ValueStatistics statistics;
    double smallest = std::numeric_limits<double>::infinity(); ///< of the magnitudes of (value - offset) that are not 0
    double largest = 0;

    void add(double value, double offset) {
        statistics.add(value);
        const double magnitude = std::abs(value - offset);
        if (!(magnitude > 0) || std::isinf(magnitude)) return; // also NaN
        smallest = std::min(smallest, magnitude);
        largest = std::max(largest, magnitude);
    }
    void combine(const ValueSummary& other) {
        statistics.combine(other.statistics);
        smallest = std::min(smallest, other.smallest);
        largest = std::max(largest, other.largest);
    }
};

/// The same of many values, each lane of every 16th. Number: double, or float for float32 values without offset.
template <class Number>
class SummaryLanes {
public:
    static constexpr std::size_t count = 16;

    SummaryLanes() {
        lower_.fill(infinity);
        upper_.fill(-infinity);
        smallest_.fill(infinity);
        largest_.fill(0);
    }

    using Values = std::array<Number, count>;

    /// Returns whether all are finite.
    bool add(const Values& values, Number offset) {
        std::uint32_t odd = 0;
        for (std::size_t k = 0; k < count; ++k) {
            const Number value = values[k], size = std::abs(value), magnitude = std::abs(value - offset);
            const bool finite = size < infinity; // false for NaN
            no_data_[k] += value != value;
            infinite_[k] += size == infinity;
            // No short cuts: they would be branches.
            lower_[k] = (finite & (value < lower_[k])) ? value : lower_[k];
            upper_[k] = (finite & (value > upper_[k])) ? value : upper_[k];
            smallest_[k] = (finite & (magnitude > 0) & (magnitude < smallest_[k])) ? magnitude : smallest_[k];
            largest_[k] = (finite & (magnitude > largest_[k])) ? magnitude : largest_[k];
            odd |= std::uint32_t{!finite};
        }
        return !odd;
    }

    ValueSummary summary() const {
        ValueSummary all;
        for (std::size_t k = 0; k < count; ++k)
            all.combine({{static_cast<double>(lower_[k]), static_cast<double>(upper_[k]), no_data_[k], infinite_[k]},
                         static_cast<double>(smallest_[k]),
                         static_cast<double>(largest_[k])});
        return all;
    }

private:
    static constexpr Number infinity = std::numeric_limits<Number>::infinity();
    Values lower_, upper_, smallest_, largest_;
    std::array<std::uint32_t, count> no_data_{}, infinite_{};
};

} // namespace isotet::core
