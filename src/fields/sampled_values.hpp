// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Some values of a field, and what they tell.
#pragma once

#include <cstddef>
#include <vector>

#include <isotet/array.hpp>

namespace isotet::core {

/// The finite ones among the sampled values, magnitudes of vectors; and how many were sampled.
struct SampledValues {
    std::vector<double> values;
    std::size_t taken = 0;
};

/// Up to 200,000 values, spread evenly.
SampledValues sample_values(const Array& array);

/// How evenly values are spread over their range: the entropy of a histogram of 64 bins; 0: all are the same. Missing
/// values count against it.
double variation_of(const SampledValues& sample);

/// Not so for vectors, whose magnitudes are looked at.
bool holds_whole_numbers(const Array& array, const SampledValues& sample);

} // namespace isotet::core
