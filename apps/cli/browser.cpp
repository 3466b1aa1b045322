// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "browser.hpp"

#include <array>
#include <cstdlib>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace isotet::cli {

namespace {

std::string_view environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

} // namespace

bool is_over_ssh() { return !environment("SSH_CONNECTION").empty(); }

std::string ssh_line(std::uint16_t port) {
    // SSH_CONNECTION: address and port of the client, address and port of this machine.
    std::string_view host = environment("SSH_CONNECTION");
    for (int part = 0; part < 2 && !host.empty(); ++part) {
        const std::size_t blank = host.find(' ');
        host = blank == std::string_view::npos ? std::string_view() : host.substr(blank + 1);
    }
    host = host.substr(0, host.find(' '));
    const std::string_view user = environment("USER");
    return fmt::format("ssh -N -L {0}:127.0.0.1:{0} {1}{2}{3}", port, user, user.empty() ? "" : "@",
                       host.empty() ? "HOST" : host);
}

bool open_browser(const std::string& address) {
    if (environment("DISPLAY").empty() && environment("WAYLAND_DISPLAY").empty()) return false;
    posix_spawn_file_actions_t quiet;
    if (posix_spawn_file_actions_init(&quiet) != 0) return false;
    for (const int stream : {0, 1, 2}) posix_spawn_file_actions_addopen(&quiet, stream, "/dev/null", O_RDWR, 0);
    std::string program = "xdg-open", argument = address;
    std::array<char*, 3> words{program.data(), argument.data(), nullptr};
    pid_t child = 0;
    const int failed = posix_spawnp(&child, "xdg-open", &quiet, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&quiet);
    return failed == 0; // xdg-open ends when the browser has the address; isotet does not wait for it
}

} // namespace isotet::cli
