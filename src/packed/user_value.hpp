// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Stored values as the user had them.
#pragma once

#include <cmath>
#include <limits>
#include <type_traits>

#include "numbers/storage.hpp"

namespace isotet::core {

/// A value in the user's type: integers are rounded, and kept within it.
template <class To>
To as_user_value(double value) {
    if constexpr (std::is_floating_point_v<To>) return static_cast<To>(value);
    else {
        if (is_nan(value)) return To{0};
        const double lower = static_cast<double>(std::numeric_limits<To>::min());
        const double upper = static_cast<double>(std::numeric_limits<To>::max());
        const double rounded = std::nearbyint(value);
        if (rounded <= lower) return std::numeric_limits<To>::min();
        if (rounded >= upper) return std::numeric_limits<To>::max();
        return static_cast<To>(rounded);
    }
}

/// A stored value in the user's type.
template <class To>
To user_value(double stored, const Storage& storage) {
    if (std::abs(stored) >= stored_infinity) return as_user_value<To>(std::copysign(HUGE_VAL, stored));
    return as_user_value<To>(restore_value(stored, storage));
}

} // namespace isotet::core
