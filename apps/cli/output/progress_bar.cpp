// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "output/progress_bar.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "output/standard_streams.hpp"
#include "output/text.hpp"

namespace isotet::cli {

void ProgressBar::show(std::string_view step, double fraction) {
    if (!enabled_) return;
    const std::lock_guard lock(mutex_);
    const Clock::time_point now = Clock::now();
    if (step != step_) {
        step_ = step;
        step_began_ = now;
        last_drawn_ = {};
    }
    using namespace std::chrono_literals;
    if (now - step_began_ < 500ms || now - last_drawn_ < 100ms) return;
    last_drawn_ = now;
    constexpr int cells = 30;
    const double done = fraction >= 0 ? std::min(fraction, 1.0) : 0.0; // NaN counts as nothing done
    const int full = static_cast<int>(done * cells);
    write_to_stderr(fmt::format("\r\x1b[K{:<8} [{:#<{}}{:<{}}] {:3.0f} %", printable(step), "", full, "", cells - full,
                                done * 100));
    drawn_ = true;
}

void ProgressBar::clear() {
    const std::lock_guard lock(mutex_);
    if (drawn_) write_to_stderr("\r\x1b[K");
    drawn_ = false;
}

} // namespace isotet::cli
