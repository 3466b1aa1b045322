// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Runs a program as a reader process and waits for it, whatever it does.
#pragma once

#include <chrono>
#include <string>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet::io::vtk {

/// Descriptors that a reader process finds open besides 0 (/dev/null), 1 and 2 (both collected); all others are closed.
constexpr int request_descriptor = 3; ///< read only: the request
constexpr int reply_descriptor = 4;   ///< memory file for the reply
constexpr int status_descriptor = 5;  ///< pipe: bytes 0 to 100 are per cent done, 255 says that memory ran out

constexpr unsigned char status_memory_ran_out = 255;
constexpr const char* reader_process_argument = "--reader-process";

struct ChildRun {
    std::string program;  ///< absolute path
    int request = -1;     ///< borrowed
    int reply = -1;       ///< borrowed
    std::chrono::steady_clock::duration time_limit{};
};

struct ChildOutcome {
    /// `not_known`: it has ended, but this program ignores SIGCHLD, or waits for all its children elsewhere.
    enum class End { exited, killed, timed_out, cancelled, not_known } end = End::exited;
    int number = 0;              ///< exit status or signal
    bool memory_ran_out = false;
    std::string last_output;     ///< the last lines that it printed, at most 4 KiB, control characters escaped
};

/// Guarantees   the process has ended when this returns; no other one is ever killed; a cancel takes less than 100 ms; a
///              process whose parent dies is killed by the system (the reader asks for that first of all)
/// Errors       machine when the program cannot be started
Result<ChildOutcome> run_child(const ChildRun& run, const Progress& progress);

} // namespace isotet::io::vtk
