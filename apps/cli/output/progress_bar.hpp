// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A line on the terminal that shows how far the running step is.
#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

namespace isotet::cli {

/// Draws on standard error, at most ten times a second, and only once an operation has lasted half a second.
///
/// Threads  safe from many threads
class ProgressBar {
public:
    /// `enabled` false: nothing is ever drawn.
    explicit ProgressBar(bool enabled) : enabled_(enabled) {}
    ~ProgressBar() { clear(); }
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(std::string_view step, double fraction);

    /// Takes the line away, before something else is printed.
    void clear();

private:
    using Clock = std::chrono::steady_clock;
    std::mutex mutex_;
    bool enabled_;
    bool drawn_ = false;
    std::string step_;
    Clock::time_point step_began_{};
    Clock::time_point last_drawn_{};
};

} // namespace isotet::cli
