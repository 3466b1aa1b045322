// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/color/linear_light.hpp"

#include <algorithm>
#include <cmath>

namespace isotet::render {

double linear_light(double part) {
    const double p = std::clamp(part, 0.0, 1.0);
    return p <= 0.04045 ? p / 12.92 : std::pow((p + 0.055) / 1.055, 2.4);
}

// In double: libraries differ in the last bit of a power, which rounding to float hides.
Light linear_light(const Color& color) {
    return {static_cast<float>(linear_light(double{color.red})), static_cast<float>(linear_light(double{color.green})),
            static_cast<float>(linear_light(double{color.blue}))};
}

} // namespace isotet::render
