// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A program that runs as a reader process and answers one request after another, whatever it does.
#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <sys/types.h>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "base/system/descriptor.hpp"
#include "base/system/process_handle.hpp"

namespace isotet::io::confined {

struct ChildOutcome {
    /// `not_known`: it has ended, but this program ignores SIGCHLD, or waits for all its children elsewhere.
    enum class End { replied, exited, killed, timed_out, cancelled, not_known } end = End::exited;
    int number = 0;                                                        ///< exit status or signal
    bool taken = false;                                                    ///< it took the request
    bool memory_ran_out = false, time_ran_out = false, file_limit = false; ///< as it said itself
    std::string last_output; ///< the last lines that it printed, at most 4 KiB, control characters escaped
};

/// One reader process. Not for several threads at once.
class ReaderChild {
public:
    /// Errors   system when the program cannot be started
    static Result<std::unique_ptr<ReaderChild>> start(const std::string& program);

    /// Hands two memory files over and waits for the reply. Only after `replied` can more be asked.
    ///
    /// Guarantees   unless it replied, the process has ended when this returns; no other one is ever killed; a cancel
    ///              takes less than 200 ms; a process whose parent dies ends (the reader watches the socket)
    ChildOutcome ask(int request, int reply, std::chrono::steady_clock::time_point deadline, const Progress& progress);

    /// Forgets the process: for the copy of this object in a process that was forked off.
    void abandon();

    /// It can be asked again.
    bool waits() const noexcept { return running_ && channel_; }

    /// Ends the process.
    ~ReaderChild();
    ReaderChild(const ReaderChild&) = delete;
    ReaderChild& operator=(const ReaderChild&) = delete;

private:
    ReaderChild(pid_t process, core::Descriptor channel, core::Descriptor output);

    void wait_a_little(std::chrono::steady_clock::time_point deadline, const Progress& progress);
    void read_output(ChildOutcome& outcome);
    void read_status(ChildOutcome& outcome, const Progress& progress);
    bool ended(ChildOutcome& outcome, int flags);
    void kill(ChildOutcome& outcome, ChildOutcome::End why);

    core::ProcessHandle process_;
    core::Descriptor channel_, output_;
    bool running_ = true;
};

} // namespace isotet::io::confined
