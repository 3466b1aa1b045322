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

/// Opens an address by xdg-open, which goes on by itself. False where there is no screen or no xdg-open.
bool open_browser(const std::string& address);

} // namespace isotet::cli
