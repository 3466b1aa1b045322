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
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include <fmt/core.h>

#include "io/vtk/child_process.hpp"
#include "io/own/file_kind.hpp"
#include "io/vtk/escape.hpp"

extern char** environ;

namespace isotet::io::vtk {
namespace {

constexpr std::size_t most_output = 4096;

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

class Watch {
public:
    Watch(pid_t process, Pipe& output, Pipe& status, const Progress& progress)
        : process_(process), output_(output.read_end), status_(status.read_end), progress_(progress) {}

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
        pollfd files[] = {{output_.number(), POLLIN, 0}, {status_.number(), POLLIN, 0}}; // closed ones (-1) are ignored
        const bool ending = !output_ || !status_;
        ::poll(files, 2, ending ? 2 : 25);
    }
    void read_pipes() {
        if (output_ && !drain(output_.number(), [&](std::string_view text) {
                outcome_.last_output.append(text);
                if (outcome_.last_output.size() > 2 * most_output) trim();
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
        outcome_.last_output.erase(0, outcome_.last_output.size() - std::min(outcome_.last_output.size(), most_output));
    }

    bool ended(int flags) {
        int status = 0;
        pid_t result;
        do result = ::waitpid(process_, &status, flags);
        while (result < 0 && errno == EINTR);
        if (result == 0) return false;
        // Where the host program ignores SIGCHLD there is no status (ECHILD): the reply then speaks for itself.
        if (result == process_ && WIFSIGNALED(status)) {
            outcome_.end = ChildOutcome::End::killed;
            outcome_.number = WTERMSIG(status);
        } else if (result == process_) {
            outcome_.number = WEXITSTATUS(status);
        }
        return true;
    }
    ChildOutcome kill(ChildOutcome::End why) {
        ::kill(-process_, SIGKILL); // its whole group: a script used as reader_program may have children
        ::kill(process_, SIGKILL);
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

    pid_t process_;
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
        return Error{ErrorCode::machine, fmt::format("a reader process cannot be started: {}", std::strerror(errno))};

    // The process is tied to the thread that starts it (PR_SET_PDEATHSIG), which stays here until it has ended.
    const auto deadline = std::chrono::steady_clock::now() + run.time_limit;
    pid_t process = -1;
    const int failure =
        spawn(run, request.number(), reply.number(), output.write_end.number(), status.write_end.number(), process);
    output.write_end.reset();
    status.write_end.reset();
    if (failure != 0)
        return Error{ErrorCode::machine, fmt::format("the reader program \"{}\" cannot be started: {}",
                                                     escaped(run.program), std::strerror(failure))};
    return Watch(process, output, status, progress).until(deadline);
}

} // namespace isotet::io::vtk
