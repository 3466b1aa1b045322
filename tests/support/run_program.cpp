// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "support/run_program.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>

namespace isotet::test {
namespace {

struct Pipe {
    int read = -1, write = -1;
    Pipe() {
        int ends[2] = {-1, -1};
        if (::pipe2(ends, O_CLOEXEC) != 0) std::abort();
        read = ends[0];
        write = ends[1];
    }
};

/// What the child does between fork and exec: only what is safe there.
[[noreturn]] void become(const std::vector<char*>& arguments, const RunOptions& options, const Pipe& out,
                         const Pipe& err) {
    // A shell that runs the tests in the background may have left these ignored.
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGXFSZ}) std::signal(number, SIG_DFL);
    const int null = ::open("/dev/null", O_RDONLY);
    ::dup2(null, 0);
    if (options.stdout_file.empty()) ::dup2(out.write, 1);
    else ::dup2(::open(options.stdout_file.c_str(), O_WRONLY), 1);
    ::dup2(err.write, 2);
    if (null > 2) ::close(null);
    for (const int descriptor : options.closed) ::close(descriptor);
    if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) ::_exit(127);
    for (const auto& [name, value] : options.environment) ::setenv(name.c_str(), value.c_str(), 1);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
}

} // namespace

RunResult run_program(std::vector<std::string> words, const RunOptions& options) {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const Pipe out, err;
    const pid_t child = ::fork();
    if (child < 0) std::abort();
    if (child == 0) become(arguments, options, out, err);
    ::close(out.write);
    ::close(err.write);

    RunResult result;
    const auto start = std::chrono::steady_clock::now(), end = start + options.limit;
    const auto milliseconds_to = [](std::chrono::steady_clock::time_point then) {
        return std::chrono::duration_cast<std::chrono::milliseconds>(then - std::chrono::steady_clock::now()).count();
    };
    const bool by_clock = options.interrupt_after.has_value();
    const auto signal_time = start + options.interrupt_after.value_or(std::chrono::milliseconds(0));
    bool to_interrupt = by_clock || !options.interrupt_when.empty();
    std::pair<int, std::string*> streams[] = {{out.read, &result.out}, {err.read, &result.err}};
    while (streams[0].first >= 0 || streams[1].first >= 0) {
        const auto left = milliseconds_to(end);
        auto patience = std::min<long long>(left, 1000);
        if (by_clock && to_interrupt) patience = std::clamp<long long>(milliseconds_to(signal_time), 0, patience);
        pollfd waiting[] = {{streams[0].first, POLLIN, 0}, {streams[1].first, POLLIN, 0}};
        const int ready = left > 0 ? ::poll(waiting, 2, static_cast<int>(patience)) : 0;
        if (left <= 0 && !std::exchange(result.timed_out, true)) ::kill(child, SIGKILL);
        if (left <= -2000) break; // a grandchild holds the pipe open
        if (by_clock && to_interrupt && milliseconds_to(signal_time) <= 0) {
            ::kill(child, options.signal);
            to_interrupt = false;
            result.interrupted = true;
        }
        if (ready <= 0) continue;
        for (int i = 0; i < 2; ++i) {
            if (streams[i].first < 0 || waiting[i].revents == 0) continue;
            char buffer[65536];
            const ssize_t count = ::read(streams[i].first, buffer, sizeof buffer);
            if (count > 0) streams[i].second->append(buffer, static_cast<std::size_t>(count));
            else if (count == 0 || errno != EINTR) ::close(std::exchange(streams[i].first, -1));
        }
        if (!by_clock && to_interrupt && result.err.find(options.interrupt_when) != std::string::npos) {
            ::kill(child, options.signal);
            to_interrupt = false;
            result.interrupted = true;
        }
    }
    for (auto& [descriptor, text] : streams) {
        if (descriptor >= 0) ::close(descriptor);
    }
    int status = 0;
    while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    if (WIFEXITED(status)) result.status = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
    return result;
}

} // namespace isotet::test
