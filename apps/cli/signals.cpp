// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "signals.hpp"

#include <csignal>

namespace isotet::cli {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

namespace {

constexpr int stopping_signals[] = {SIGINT, SIGTERM, SIGHUP};

extern "C" void stop(int) {
    stop_requested.store(true, std::memory_order_relaxed);
    for (const int other : stopping_signals) std::signal(other, SIG_DFL);
}

} // namespace

void install_signal_handlers() {
    for (const int number : stopping_signals) {
        struct sigaction old{};
        sigaction(number, nullptr, &old);
        if (old.sa_handler == SIG_IGN) continue;
        struct sigaction action{};
        action.sa_handler = stop;
        action.sa_flags = SA_RESTART;
        sigemptyset(&action.sa_mask);
        sigaction(number, &action, nullptr);
    }
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

} // namespace isotet::cli
