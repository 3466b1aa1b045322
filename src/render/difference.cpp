// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstdlib>

#include <fmt/core.h>

#include <isotet/picture.hpp>

namespace isotet {

Result<double> difference(const Picture& a, const Picture& b, int tolerance) {
    if (a.width != b.width || a.height != b.height) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("a picture of {} x {} and one of {} x {} cannot be compared", a.width, a.height,
                                 b.width, b.height)};
    }
    if (a.pixels.empty()) return 0.0;
    std::size_t differing = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        const auto &p = a.pixels[i], &q = b.pixels[i];
        if (p[3] == 0 && q[3] == 0) continue;
        differing += !std::ranges::equal(p, q, [&](int x, int y) { return std::abs(x - y) <= tolerance; });
    }
    return static_cast<double>(differing) / static_cast<double>(a.pixels.size());
}

} // namespace isotet
