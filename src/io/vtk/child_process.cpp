// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// posix_spawn (which does not copy the parent's address space: a parent with a grid of 100 GB can start a child), then
// a loop over its two pipes. Limits on memory are set by the child itself before it looks at the file.
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <string>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include <fmt/core.h>

#include "io/vtk/child_process.hpp"
#include "io/own/file_kind.hpp"
#include "io/own/escape.hpp"

extern char** environ;

namespace isotet::io::vtk {
namespace {

constexpr std::size_t max_output = 4096;

struct Pipe {
    Descriptor read_end, write_end;
};

/// Numbers from 10 on, so that placing them at 0 to 5 in the child never overwrites one that is still to be placed.
Descriptor duplicate_high(int descriptor) { return Descriptor(::fcntl(descriptor, F_DUPFD_CLOEXEC, 10)); }

Pipe make_pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) return {Descriptor(), Descriptor()};
    const Descriptor low_read(ends[0]), low_write(ends[1]);
    Pipe pipe{duplicate_high(ends[0]), duplicate_high(ends[1])};
    if (pipe.read_end) ::fcntl(pipe.read_end.number(), F_SETFL, O_NONBLOCK);
    return pipe;
}

struct SpawnSettings {
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    SpawnSettings() {
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawnattr_init(&attributes);
    }
    ~SpawnSettings() {
        ::posix_spawn_file_actions_destroy(&actions);
        ::posix_spawnattr_destroy(&attributes);
    }
    SpawnSettings(const SpawnSettings&) = delete;
    SpawnSettings& operator=(const SpawnSettings&) = delete;
};

/// Default signals, and a process group of its own: Ctrl-C reaches the parent alone, which cancels.
int spawn(const ChildRun& run, int request, int reply, int output, int status, pid_t& process) {
    SpawnSettings settings;
    ::posix_spawn_file_actions_addopen(&settings.actions, 0, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&settings.actions, output, 1);
    ::posix_spawn_file_actions_adddup2(&settings.actions, output, 2);
    ::posix_spawn_file_actions_adddup2(&settings.actions, request, request_descriptor);
    ::posix_spawn_file_actions_adddup2(&settings.actions, reply, reply_descriptor);
    ::posix_spawn_file_actions_adddup2(&settings.actions, status, status_descriptor);
    ::posix_spawn_file_actions_addclosefrom_np(&settings.actions, status_descriptor + 1);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    ::posix_spawnattr_setsigmask(&settings.attributes, &none);
    ::posix_spawnattr_setsigdefault(&settings.attributes, &all);
    ::posix_spawnattr_setpgroup(&settings.attributes, 0);
    ::posix_spawnattr_setflags(&settings.attributes,
                               POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);

    const std::string parent = std::to_string(::getpid());
    char name[] = "isotet";
    std::string argument = reader_process_argument, parent_argument = parent;
    char* arguments[] = {name, argument.data(), parent_argument.data(), nullptr};
    return ::posix_spawn(&process, run.program.c_str(), &settings.actions, &settings.attributes, arguments, environ);
}

/// Empties a pipe; false when its other end is closed.
template <class Take>
bool drain(int descriptor, Take take) {
    char buffer[4096];
    while (true) {
        const ssize_t size = ::read(descriptor, buffer, sizeof buffer);
        if (size > 0) take(std::string_view(buffer, static_cast<std::size_t>(size)));
        else if (size == 0) return false;
        else if (errno != EINTR) return errno == EAGAIN;
    }
}

/// A child by a descriptor, which stays its own: as soon as somebody in this program has waited for the child (a handler
/// of SIGCHLD, say), its number may be another process's. Before Linux 5.4 there is the number alone.
class Child {
public:
    explicit Child(pid_t number)
        : number_(number), descriptor_(static_cast<int>(::syscall(SYS_pidfd_open, number, 0))) {}

    /// Can be read once the child has ended; -1 where there is none.
    int descriptor() const noexcept { return descriptor_.number(); }

    enum class State { runs, ended, taken };

    /// Waits for the end where `flags` do not say WNOHANG. `taken`: it has ended, and somebody else has its status.
    State state(siginfo_t& info, int flags) {
        info.si_pid = 0;
        const int failed = descriptor_ ? ::waitid(by_descriptor, static_cast<id_t>(descriptor_.number()), &info, flags)
                                       : ::waitid(P_PID, static_cast<id_t>(number_), &info, flags);
        if (failed == 0) return info.si_pid == 0 ? State::runs : State::ended;
        if (errno == EINTR) return state(info, flags);
        if (errno != EINVAL || !descriptor_) return State::taken;
        descriptor_.reset(); // a system that has descriptors, but does not wait by them
        return state(info, flags);
    }

    /// Kills it with its process group: a script used as reader_program may have children.
    void kill() {
        siginfo_t info{};
        // As long as its status is there, its number is no other group's.
        if (state(info, WEXITED | WNOHANG | WNOWAIT) != State::taken) ::kill(-number_, SIGKILL);
        if (descriptor_) ::syscall(SYS_pidfd_send_signal, descriptor_.number(), SIGKILL, nullptr, 0);
        else ::kill(number_, SIGKILL);
    }

private:
    static constexpr auto by_descriptor = static_cast<idtype_t>(3); // P_PIDFD; older C libraries do not name it

    pid_t number_;
    Descriptor descriptor_;
};

class Watch {
public:
    Watch(pid_t process, Pipe& output, Pipe& status, const Progress& progress)
        : child_(process), output_(output.read_end), status_(status.read_end), progress_(progress) {}

    ChildOutcome until(std::chrono::steady_clock::time_point deadline) {
        while (true) {
            if (ended(WNOHANG)) return finish();
            if (progress_.cancelled()) return kill(ChildOutcome::End::cancelled);
            if (std::chrono::steady_clock::now() >= deadline) return kill(ChildOutcome::End::timed_out);
            wait_a_little();
            read_pipes();
        }
    }

private:
    void wait_a_little() {
        pollfd files[] = {{output_.number(), POLLIN, 0}, // those that are closed (-1) are ignored
                          {status_.number(), POLLIN, 0},
                          {child_.descriptor(), POLLIN, 0}};
        const bool ending = !output_ || !status_;
        ::poll(files, 3, ending && child_.descriptor() < 0 ? 2 : 25);
    }
    void read_pipes() {
        if (output_ && !drain(output_.number(), [&](std::string_view text) {
                outcome_.last_output.append(text);
                if (outcome_.last_output.size() > 2 * max_output) trim();
            }))
            output_.reset();
        if (status_ && !drain(status_.number(), [&](std::string_view bytes) {
                for (const char byte : bytes) take_status(static_cast<unsigned char>(byte));
            }))
            status_.reset();
    }
    void take_status(unsigned char byte) {
        if (byte == status_memory_ran_out) outcome_.memory_ran_out = true;
        else if (byte <= 100) progress_("read", byte / 100.0);
    }
    void trim() {
        outcome_.last_output.erase(0, outcome_.last_output.size() - std::min(outcome_.last_output.size(), max_output));
    }

    bool ended(int flags) {
        siginfo_t info{};
        switch (child_.state(info, WEXITED | flags)) {
        case Child::State::runs: return false;
        case Child::State::taken: outcome_.end = ChildOutcome::End::not_known; return true;
        case Child::State::ended: break;
        }
        outcome_.number = info.si_status;
        if (info.si_code != CLD_EXITED) outcome_.end = ChildOutcome::End::killed;
        return true;
    }
    ChildOutcome kill(ChildOutcome::End why) {
        child_.kill();
        ended(0);
        outcome_.end = why;
        return finish();
    }
    ChildOutcome finish() {
        read_pipes();
        trim();
        outcome_.last_output = escaped(outcome_.last_output);
        return std::move(outcome_);
    }

    Child child_;
    Descriptor& output_;
    Descriptor& status_;
    const Progress& progress_;
    ChildOutcome outcome_;
};

} // namespace

Result<ChildOutcome> run_child(const ChildRun& run, const Progress& progress) {
    Pipe output = make_pipe(), status = make_pipe();
    const Descriptor request = duplicate_high(run.request), reply = duplicate_high(run.reply);
    if (!output.read_end || !output.write_end || !status.read_end || !status.write_end || !request || !reply)
        return Error{ErrorCode::system, fmt::format("a reader process cannot be started: {}", std::strerror(errno))};

    // The process is tied to the thread that starts it (PR_SET_PDEATHSIG), which stays here until it has ended.
    const auto deadline = std::chrono::steady_clock::now() + run.time_limit;
    pid_t process = -1;
    const int failure =
        spawn(run, request.number(), reply.number(), output.write_end.number(), status.write_end.number(), process);
    output.write_end.reset();
    status.write_end.reset();
    if (failure != 0)
        return Error{ErrorCode::system, fmt::format("the reader program \"{}\" cannot be started: {}",
                                                    escaped(run.program), std::strerror(failure))};
    return Watch(process, output, status, progress).until(deadline);
}

} // namespace isotet::io::vtk
