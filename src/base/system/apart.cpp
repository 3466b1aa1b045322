// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/system/apart.hpp"

#ifndef __wasm__
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <new>
#include <thread>

#include <sys/mman.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#else
#include <cstdlib>
#endif

namespace isotet::core {

#ifndef __wasm__
namespace {

void* map_shared_or_own(std::size_t bytes, int kind) {
    void* const data = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, kind | MAP_ANONYMOUS, -1, 0);
    return data == MAP_FAILED ? nullptr : data;
}

thread_local bool is_starting = false;

/// Keeps signals from this thread, and from a process that it starts: that one runs no handler, and says nothing.
class NoSignals {
public:
    NoSignals() {
        sigset_t all;
        ::sigfillset(&all);
        ::pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    ~NoSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    NoSignals(const NoSignals&) = delete;
    NoSignals& operator=(const NoSignals&) = delete;

private:
    sigset_t before_{};
};

/// Whether it has ended, or another part of this program has waited for it.
bool has_ended(pid_t process, int flags) {
    pid_t ended = 0;
    do ended = ::waitpid(process, nullptr, flags);
    while (ended < 0 && errno == EINTR);
    return ended != 0;
}

[[noreturn]] void carry_out_as_child(pid_t parent, const std::function<void()>& work, std::atomic<bool>& done) {
#ifdef __linux__
    ::prctl(PR_SET_PDEATHSIG, SIGKILL); // without this process there is no use for the result
#endif
    if (::getppid() != parent) ::_exit(1);
    work();
    done = true;
    ::_exit(0);
}

} // namespace

bool starts_apart() noexcept { return is_starting; }

SharedMemory::SharedMemory(std::size_t bytes) : data_(map_shared_or_own(bytes, MAP_SHARED)), bytes_(bytes) {}
SharedMemory::~SharedMemory() {
    if (data_) ::munmap(data_, bytes_);
}

void* take_pages(std::size_t bytes) {
    void* const data = map_shared_or_own(std::max<std::size_t>(bytes, 1), MAP_PRIVATE);
    if (!data) ::_exit(1);
    return data;
}

Apart run_apart(const Progress& progress, const std::function<void()>& work) {
    using namespace std::chrono_literals;
    const SharedMemory flag(sizeof(std::atomic<bool>));
    if (!flag.data()) return Apart::refused;
    auto& done = *new (flag.data()) std::atomic<bool>(false);
    const pid_t parent = ::getpid();
    pid_t child = 0;
    {
        const NoSignals blocked;
        is_starting = true;
        child = ::fork();
        is_starting = false;
        if (child == 0) carry_out_as_child(parent, work, done);
    }
    if (child < 0) return Apart::refused;
    for (std::chrono::microseconds pause = 100us; !has_ended(child, WNOHANG); pause = std::min(2 * pause, 10'000us)) {
        if (progress.cancelled()) {
            ::kill(child, SIGKILL);
            has_ended(child, 0);
            return Apart::cancelled;
        }
        std::this_thread::sleep_for(pause);
    }
    return done ? Apart::done : Apart::failed;
}

#else

bool starts_apart() noexcept { return false; }
SharedMemory::SharedMemory(std::size_t bytes) : bytes_(bytes) {}
SharedMemory::~SharedMemory() = default;
void* take_pages(std::size_t) { std::abort(); }
Apart run_apart(const Progress&, const std::function<void()>&) { return Apart::refused; }

#endif

} // namespace isotet::core
