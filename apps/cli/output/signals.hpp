// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Ctrl-C: the first asks the running operation to stop, and ends the program if that takes long; the second ends it at
// once.
#pragma once

#include <atomic>
#include <string_view>

namespace isotet::cli {

/// Set by the first SIGINT, SIGTERM or SIGHUP; goes into Progress::cancel.
extern std::atomic<bool> stop_requested;

inline constexpr std::string_view interrupted_sentence = "isotet: interrupted: no file was left half written\n";

/// SIGINT, SIGTERM and SIGHUP set `stop_requested`; whichever comes second has its default effect. What still runs a
/// fifth of a second later is ended in its midst, and what it was writing removed. A signal that was ignored
/// when the program started (nohup, a shell's background job) stays ignored. SIGPIPE and SIGXFSZ are ignored:
/// the write that caused them fails, and its error is told like any other.
void install_signal_handlers();

/// From here on the program ends by itself when it is asked to stop, however long that takes: a server.
void take_time_to_stop();

} // namespace isotet::cli
