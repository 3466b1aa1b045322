// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/system/process_handle.hpp"

#include <cerrno>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace isotet::core {

constexpr auto by_descriptor = static_cast<idtype_t>(3); // P_PIDFD; older C libraries do not name it

ProcessHandle::ProcessHandle(pid_t number)
    : number_(number), descriptor_(static_cast<int>(::syscall(SYS_pidfd_open, number, 0))) {}

ProcessHandle::State ProcessHandle::state(siginfo_t& info, int flags) {
    info.si_pid = 0;
    const int failed = descriptor_ ? ::waitid(by_descriptor, static_cast<id_t>(descriptor_.number()), &info, flags)
                                   : ::waitid(P_PID, static_cast<id_t>(number_), &info, flags);
    if (failed == 0) return info.si_pid == 0 ? State::runs : State::ended;
    if (errno == EINTR) return state(info, flags);
    if (errno != EINVAL || !descriptor_) return State::taken;
    descriptor_.reset(); // a system that has descriptors, but does not wait by them
    return state(info, flags);
}

void ProcessHandle::kill() {
    siginfo_t info{};
    // As long as its status is there, its number is no other group's.
    if (state(info, WEXITED | WNOHANG | WNOWAIT) != State::taken) ::kill(-number_, SIGKILL);
    if (descriptor_) ::syscall(SYS_pidfd_send_signal, descriptor_.number(), SIGKILL, nullptr, 0);
    else ::kill(number_, SIGKILL);
}

} // namespace isotet::core
