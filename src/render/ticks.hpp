// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Round numbers along a scale, and how they are written.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <isotet/scene.hpp>

namespace isotet::render {

struct Tick {
    double value = 0;
    std::string label;
};

/// Ticks within a scale, ascending: multiples of 1, 2 or 5 times a power of ten, at most `most` (at least 2); on a
/// logarithmic scale powers of ten, or 1, 2 and 5 times these where there are few. Ends that are no round numbers have
/// no tick; a scale in which there is no round number at all has its two ends.
std::vector<Tick> ticks_of(const ColorScale& scale, std::size_t most);

/// "0.25", "−3", "1.5×10⁶": up to four significant digits, in the locale's spite.
std::string number_label(double value);

} // namespace isotet::render
