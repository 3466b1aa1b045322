// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// posix_spawn (which does not copy the parent's address space: a parent with a grid of 100 GB can start a child), then
// a loop over the socket, the output and the end of the process. Limits are set by the child itself before it looks at
// the file.
#include "io/process/child_process.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "base/system/channel.hpp"

extern char** environ;

namespace isotet::io::confined {
namespace {

constexpr std::size_t max_output = 4096;

struct Ends {
    core::Descriptor ours = core::Descriptor(), theirs = core::Descriptor();
    explicit operator bool() const noexcept { return ours && theirs; }
};

/// Numbers from 10 on, so that placing them at 0 to 3 in the child never overwrites one that is still to be placed.
Ends high_ends(const int (&ends)[2]) {
    const core::Descriptor low_ours(ends[0]), low_theirs(ends[1]);
    Ends high{core::Descriptor(::fcntl(ends[0], F_DUPFD_CLOEXEC, 10)),
              core::Descriptor(::fcntl(ends[1], F_DUPFD_CLOEXEC, 10))};
    if (high.ours) ::fcntl(high.ours.number(), F_SETFL, O_NONBLOCK);
    return high;
}

Ends make_pipe() {
    int ends[2];
    return ::pipe2(ends, O_CLOEXEC) == 0 ? high_ends(ends) : Ends{};
}

Ends make_channel() {
    int ends[2];
    return ::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) == 0 ? high_ends(ends) : Ends{};
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
int spawn(const std::string& program, int channel, int output, pid_t& process) {
    SpawnSettings settings;
    ::posix_spawn_file_actions_addopen(&settings.actions, 0, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_adddup2(&settings.actions, output, 1);
    ::posix_spawn_file_actions_adddup2(&settings.actions, output, 2);
    ::posix_spawn_file_actions_adddup2(&settings.actions, channel, core::channel_descriptor);
    ::posix_spawn_file_actions_addclosefrom_np(&settings.actions, core::channel_descriptor + 1);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    ::posix_spawnattr_setsigmask(&settings.attributes, &none);
    ::posix_spawnattr_setsigdefault(&settings.attributes, &all);
    ::posix_spawnattr_setpgroup(&settings.attributes, 0);
    ::posix_spawnattr_setflags(&settings.attributes,
                               POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
    char name[] = "isotet-reader";
    char* arguments[] = {name, nullptr};
    return ::posix_spawn(&process, program.c_str(), &settings.actions, &settings.attributes, arguments, environ);
}

/// Empties a pipe or socket; false when its other end is closed.
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

void keep_the_last(std::string& text) {
    if (text.size() > max_output) text.erase(0, text.size() - max_output);
}

} // namespace

Result<std::unique_ptr<ReaderChild>> ReaderChild::start(const std::string& program) {
    Ends output = make_pipe(), channel = make_channel();
    if (!output || !channel)
        return Error{ErrorCode::system, fmt::format("a reader process cannot be started: {}", std::strerror(errno))};
    pid_t process = -1;
    const int failure = spawn(program, channel.theirs.number(), output.theirs.number(), process);
    if (failure != 0)
        return Error{ErrorCode::system, fmt::format("the reader program \"{}\" cannot be started: {}", escaped(program),
                                                    std::strerror(failure))};
    return std::unique_ptr<ReaderChild>(new ReaderChild(process, std::move(channel.ours), std::move(output.ours)));
}

ReaderChild::ReaderChild(pid_t process, core::Descriptor channel, core::Descriptor output)
    : process_(process), channel_(std::move(channel)), output_(std::move(output)) {}

ReaderChild::~ReaderChild() {
    ChildOutcome ignored;
    if (running_) kill(ignored, ChildOutcome::End::exited);
}

void ReaderChild::abandon() { running_ = false; }

ChildOutcome ReaderChild::ask(int request, int reply, std::chrono::steady_clock::time_point deadline,
                              const Progress& progress) {
    ChildOutcome outcome;
    core::send_parcel(channel_.number(), request, reply); // where it fails the process has ended, or will
    while (true) {
        const bool over = ended(outcome, WNOHANG);
        read_output(outcome);
        read_status(outcome, progress);
        if (over || outcome.end == ChildOutcome::End::replied) break;
        if (progress.cancelled()) kill(outcome, ChildOutcome::End::cancelled);
        else if (std::chrono::steady_clock::now() >= deadline) kill(outcome, ChildOutcome::End::timed_out);
        if (!running_) break;
        wait_a_little(deadline, progress);
    }
    keep_the_last(outcome.last_output);
    outcome.last_output = escaped(outcome.last_output);
    return outcome;
}

/// Wakes when anything happens, at the deadline, and ten times a second where it may be cancelled.
void ReaderChild::wait_a_little(std::chrono::steady_clock::time_point deadline, const Progress& progress) {
    pollfd files[] = {{output_.number(), POLLIN, 0}, // those that are closed (-1) are ignored
                      {channel_.number(), POLLIN, 0},
                      {process_.descriptor(), POLLIN, 0}};
    using std::chrono::milliseconds;
    const auto left = std::chrono::ceil<milliseconds>(deadline - std::chrono::steady_clock::now());
    auto most = std::clamp(left, milliseconds(0), milliseconds(60000));
    if (progress.cancel) most = std::min(most, milliseconds(100));
    if (process_.descriptor() < 0) most = std::min(most, milliseconds(output_ && channel_ ? 25 : 2));
    ::poll(files, 3, static_cast<int>(most.count()));
}

void ReaderChild::read_output(ChildOutcome& outcome) {
    const bool open = !output_ || drain(output_.number(), [&](std::string_view text) {
        outcome.last_output.append(text);
        if (outcome.last_output.size() > 2 * max_output) keep_the_last(outcome.last_output);
    });
    if (!open) output_.reset();
}

void ReaderChild::read_status(ChildOutcome& outcome, const Progress& progress) {
    const bool open = !channel_ || drain(channel_.number(), [&](std::string_view bytes) {
        for (const char byte : bytes) {
            const auto status = static_cast<unsigned char>(byte);
            outcome.taken = true;
            if (status == core::status_replied) outcome.end = ChildOutcome::End::replied;
            else if (status == core::status_memory_ran_out) outcome.memory_ran_out = true;
            else if (status == core::status_time_ran_out) outcome.time_ran_out = true;
            else if (status == core::status_file_limit) outcome.file_limit = true;
            else if (status <= 100) progress("read", status / 100.0);
        }
    });
    if (!open) channel_.reset();
}

bool ReaderChild::ended(ChildOutcome& outcome, int flags) {
    siginfo_t info{};
    const auto state = process_.state(info, WEXITED | flags);
    if (state == core::ProcessHandle::State::runs) return false;
    running_ = false;
    if (state == core::ProcessHandle::State::taken) {
        outcome.end = ChildOutcome::End::not_known;
        return true;
    }
    outcome.number = info.si_status;
    outcome.end = info.si_code == CLD_EXITED ? ChildOutcome::End::exited : ChildOutcome::End::killed;
    return true;
}

void ReaderChild::kill(ChildOutcome& outcome, ChildOutcome::End why) {
    process_.kill();
    ended(outcome, 0);
    read_output(outcome);
    outcome.end = why;
}

} // namespace isotet::io::confined
