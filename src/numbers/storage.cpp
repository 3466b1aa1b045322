// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "numbers/storage.hpp"

#include <algorithm>

namespace isotet::core {

Storage choose_offset(ScalarType type, const ValueStatistics& statistics, Precision precision) {
    Storage storage;
    if (!(statistics.lower <= statistics.upper)) return storage; // nothing finite
    const double magnitude = std::max(std::abs(statistics.lower), std::abs(statistics.upper));
    const bool single = precision == Precision::float32;
    storage.unchanged =
        is_floating(type) ? type == ScalarType::float32 || !single : magnitude < (single ? 0x1p24 : 0x1p53);
    const double range = statistics.upper - statistics.lower;
    if (!storage.unchanged && range < magnitude / 8) storage.offset = statistics.lower + range / 2;
    return storage;
}

void choose_scale(Storage& storage, double smallest_magnitude, double largest_magnitude) {
    if (largest_magnitude == 0) return;
    if (largest_magnitude < largest_stored && smallest_magnitude >= tiny) return;
    // A field of denormals alone would need more than a double can hold; 2^1023 lifts the smallest of them to 2^-51.
    storage.scale = std::scalbn(1.0, std::min(56 - std::ilogb(largest_magnitude), 1023));
}

} // namespace isotet::core
