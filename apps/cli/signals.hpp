// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C: the first asks the running operation to stop, the second ends the program at once.
#pragma once

#include <atomic>

namespace isotet::cli {

/// Set by the first SIGINT, SIGTERM or SIGHUP; goes into Progress::cancel.
extern std::atomic<bool> stop_requested;

/// SIGINT, SIGTERM and SIGHUP set `stop_requested`; whichever comes second has its default effect. A signal that was
/// ignored when the program started (nohup, a shell's background job) stays ignored. SIGPIPE and SIGXFSZ are ignored:
/// the write that caused them fails, and its error is told like any other.
void install_signal_handlers();

} // namespace isotet::cli
