// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "output/signals.hpp"

#include <csignal>
#include <string_view>
#include <sys/time.h>
#include <unistd.h>

#include <isotet/write.hpp>

#include "exit_code.hpp"
#include "output/standard_streams.hpp"

namespace isotet::cli {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

namespace {

constexpr int stopping_signals[] = {SIGINT, SIGTERM, SIGHUP};
constexpr timeval time_to_stop{0, 200'000};

std::atomic<bool> may_take_its_time{false};
bool on_terminal = false;

extern "C" void stop(int) {
    stop_requested.store(true, std::memory_order_relaxed);
    for (const int other : stopping_signals) std::signal(other, SIG_DFL);
    const itimerval once{{0, 0}, time_to_stop};
    if (!may_take_its_time) setitimer(ITIMER_REAL, &once, nullptr); // a system call, as safe here as alarm()
}

extern "C" void end(int) {
    if (may_take_its_time) return;
    remove_unfinished_files();
    write_to_stderr(on_terminal ? std::string_view("\r\x1b[K") : std::string_view());
    write_to_stderr(interrupted_sentence);
    _exit(static_cast<int>(ExitCode::interrupted));
}

void handle(int number, void (*handler)(int)) {
    struct sigaction action{};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    sigaction(number, &action, nullptr);
}

} // namespace

void install_signal_handlers() {
    on_terminal = stderr_is_terminal();
    handle(SIGALRM, end);
    for (const int number : stopping_signals) {
        struct sigaction old{};
        sigaction(number, nullptr, &old);
        if (old.sa_handler != SIG_IGN) handle(number, stop);
    }
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
}

void take_time_to_stop() { may_take_its_time = true; }

} // namespace isotet::cli
