// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <csignal>
#include <sys/types.h>

#include <isotet/export.hpp>

#include "base/system/descriptor.hpp"

namespace isotet::core {

/// A child by a descriptor, which stays its own: as soon as another part of this program has waited for the child (a handler
/// of SIGCHLD, say), its number may be another process's. Before Linux 5.4 there is the number alone.
class ISOTET_API ProcessHandle {
public:
    explicit ProcessHandle(pid_t number);

    /// Can be read once the child has ended; -1 where there is none.
    int descriptor() const noexcept { return descriptor_.number(); }

    enum class State { runs, ended, taken };

    /// Waits for the end where `flags` do not say WNOHANG. `taken`: it has ended, and another part of the program has its status.
    State state(siginfo_t& info, int flags);

    /// Kills it with its process group: a script used as reader_program may have children.
    void kill();

private:
    pid_t number_;
    Descriptor descriptor_;
};

} // namespace isotet::core
