// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/surfaces/surface_colors.hpp"

#include <cmath>

namespace isotet::io {

std::array<double, 256> light_of_bytes() {
    std::array<double, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double x = static_cast<double>(i) / 255;
        table[i] = x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
    }
    return table;
}

} // namespace isotet::io
