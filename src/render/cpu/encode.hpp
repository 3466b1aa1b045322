// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Linear light as the bytes of a picture.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "render/color/linear_light.hpp"

namespace isotet::render {

/// The byte of sRGB that is nearest, by the smallest light that has each byte.
class LightBytes {
public:
    LightBytes() {
        for (std::size_t byte = 1; byte < 256; ++byte)
            smallest_[byte] = static_cast<float>(linear_light((static_cast<double>(byte) - 0.5) / 255));
        smallest_[256] = INFINITY;
        std::size_t byte = 0;
        for (std::size_t i = 0; i < first_.size(); ++i) {
            while (smallest_[byte + 1] <= static_cast<float>(i) / (first_.size() - 1)) ++byte;
            first_[i] = static_cast<std::uint8_t>(byte);
        }
    }

    std::uint8_t of(float light) const {
        const float limited = std::clamp(light, 0.0F, 1.0F);
        std::size_t byte = first_[static_cast<std::size_t>(limited * (first_.size() - 1))];
        while (byte > 0 && limited < smallest_[byte]) --byte;
        while (limited >= smallest_[byte + 1]) ++byte;
        return static_cast<std::uint8_t>(byte);
    }

private:
    std::array<float, 257> smallest_{};
    std::array<std::uint8_t, 1025> first_{};
};

} // namespace isotet::render
