// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Runs a program as a child process and tells what it wrote and how it ended.
#pragma once

#include <chrono>
#include <csignal>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace isotet::test {

struct RunOptions {
    std::vector<std::pair<std::string, std::string>> environment = {}; ///< added to that of the test
    std::string folder = {};                                           ///< to run in; empty: that of the test
    std::vector<int> closed = {};    ///< descriptors, of 0, 1 and 2, that the program finds closed
    std::string stdout_file = {};    ///< opened for writing as standard output, in place of the pipe
    std::string interrupt_when = {}; ///< when standard error holds this, the signal is sent
    std::optional<std::chrono::milliseconds> interrupt_after = {}; ///< so long after the start the signal is sent
    int signal = SIGINT;
    std::chrono::seconds limit{120}; ///< then the program is killed
};

struct RunResult {
    std::string out, err;
    int status = -1; ///< exit status; -1 when a signal ended the program
    int signal = 0;  ///< the signal that ended it; 0 when it exited
    bool timed_out = false;
    bool interrupted = false; ///< whether the signal was sent before the program closed its streams
};

/// Runs `words` (the program's path first) to its end, or to the limit.
RunResult run_program(std::vector<std::string> words, const RunOptions& options = {});

} // namespace isotet::test
