// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Float32 fields that take few values, a step of float32 apart, as fields do where hardly anything happens: an isovalue
// between two of them is none that float32 can hold.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "support/small_grid.hpp"

namespace isotet::test {

struct CloseValues {
    float base = 1.1764648f;  ///< positive; the least of the close values
    int steps = 6;            ///< the largest of them is so many steps of float32 above
    bool far_values = false;  ///< some points have values far off: 0 to 100 times `base`

    float at(int step) const {
        return std::bit_cast<float>(std::bit_cast<std::uint32_t>(base) + static_cast<std::uint32_t>(step));
    }

    /// Made of the first field of the grid, which runs from -1.5 to 1.5.
    PointField field(const Grid& grid) const {
        std::vector<float> values;
        for (const float v : grid.point_fields[0].values.as<float>()) {
            const auto step = static_cast<int>(std::lround((v + 1.5f) / 3 * static_cast<float>(steps)));
            const bool is_far = far_values && std::abs(v) > 1;
            values.push_back(is_far ? base * (v > 0 ? 100 : 0) * std::abs(v) : at(step));
        }
        return field_of(std::move(values));
    }

    /// Between two neighbouring values, `share` of a step above the lower.
    double isovalue(int step, double share) const {
        return at(step) + share * (static_cast<double>(at(step + 1)) - static_cast<double>(at(step)));
    }
};

} // namespace isotet::test
