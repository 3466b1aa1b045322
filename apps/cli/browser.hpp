// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How a user gets to a page of this machine: by a browser here, or by a line for ssh.
#pragma once

#include <cstdint>
#include <string>

namespace isotet::cli {

/// Whether the program was started over ssh, where a browser would open on the wrong machine.
bool is_over_ssh();

/// "ssh -N -L 8123:127.0.0.1:8123 user@host": to be typed on the machine where the browser is.
std::string ssh_line(std::uint16_t port);

/// Whether ssh, which started the program without a terminal, has ended: nothing reads what it writes any more, and
/// nothing writes what it reads.
bool is_left_by_ssh();

/// A browser of this machine. It is given the name of a file that leads to the address: the address holds a token, and
/// other users see the words of every process.
class Browser {
public:
    Browser() = default;
    Browser(const Browser&) = delete;
    Browser& operator=(const Browser&) = delete;
    ~Browser(); ///< removes the file

    /// By xdg-open, which goes on by itself. False where there is no screen, no xdg-open, or no place for the file.
    bool open(const std::string& address);

private:
    std::string folder_; ///< of this user alone, with the file
};

} // namespace isotet::cli
