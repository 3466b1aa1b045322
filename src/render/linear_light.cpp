// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "render/layout.hpp"

namespace isotet::render {

layout::vec3 linear_light(const Color& color) {
    const auto linear = [](float part) {
        const float p = std::clamp(part, 0.0F, 1.0F);
        return p <= 0.04045F ? p / 12.92F : std::pow((p + 0.055F) / 1.055F, 2.4F);
    };
    return {linear(color.red), linear(color.green), linear(color.blue)};
}

} // namespace isotet::render
