// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>

namespace isotet::core {

/// Adds values to a mean one by one, so that equal values stay as they are and large ones do not overflow.
struct RunningMean {
    double mean = 0, weights = 0;

    void add(double value, double weight) {
        if (weight == 0) return;
        const bool is_first = weights == 0;
        weights += weight;
        if (is_first) mean = value;
        else if (std::isinf(value))
            mean = std::isinf(mean) && mean != value ? std::numeric_limits<double>::quiet_NaN() : value;
        else if (!std::isinf(mean)) mean += (value - mean) * (weight / weights);
    }
};

} // namespace isotet::core
