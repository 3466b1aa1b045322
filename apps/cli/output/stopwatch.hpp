// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Seconds on the clock on the wall.
#pragma once

#include <chrono>

namespace isotet::cli {

class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }

private:
    using Clock = std::chrono::steady_clock;
    Clock::time_point began_ = Clock::now();
};

} // namespace isotet::cli
