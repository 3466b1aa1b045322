// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "browser.hpp"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace isotet::cli {

namespace {

std::string_view environment(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

/// A new folder that this user alone may enter, in that of the session; empty: there is none.
std::string make_own_folder() {
    std::error_code ignored;
    std::vector<std::string> places{std::string(environment("XDG_RUNTIME_DIR")),
                                    std::filesystem::temp_directory_path(ignored).string()};
    for (const std::string& place : places) {
        if (!place.starts_with('/')) continue;
        std::string folder = place + "/isotet-view-XXXXXX";
        if (::mkdtemp(folder.data())) return folder;
    }
    return {};
}

bool write_own_file(const std::string& path, std::string_view text) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (file < 0) return false;
    const bool written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size());
    return ::close(file) == 0 && written;
}

std::string page_that_leads_to(const std::string& address) {
    std::string safe;
    for (const char c : address)
        if (c != '"' && c != '<' && c != '>' && c != '&') safe += c; // none of them is in an address
    return fmt::format("<!doctype html><meta charset=\"utf-8\"><meta name=\"referrer\" content=\"no-referrer\">"
                       "<title>isotet view</title><meta http-equiv=\"refresh\" content=\"0; url={0}\">"
                       "<a href=\"{0}\">isotet view</a>\n",
                       safe);
}

/// A path as a part of an address.
std::string in_address(std::string_view path) {
    std::string out;
    for (const char c : path) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                           std::string_view("/-._~").find(c) != std::string_view::npos;
        out += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
    }
    return out;
}

} // namespace

bool is_over_ssh() { return !environment("SSH_CONNECTION").empty(); }

bool is_left_by_ssh() {
    if (!is_over_ssh()) return false;
    const auto is_line = [](int stream) {
        struct stat status{};
        return ::fstat(stream, &status) == 0 && (S_ISFIFO(status.st_mode) || S_ISSOCK(status.st_mode));
    };
    const auto has_ended = [](int stream) {
        pollfd waiting{stream, 0, 0};
        return ::poll(&waiting, 1, 0) == 1 && (waiting.revents & (POLLHUP | POLLERR)) != 0;
    };
    return is_line(1) && has_ended(1) && (!is_line(0) || has_ended(0));
}

std::string ssh_line(std::uint16_t port) {
    // SSH_CONNECTION: address and port of the client, address and port of this machine.
    std::array<std::string, 4> words;
    std::istringstream connection{std::string(environment("SSH_CONNECTION"))};
    for (std::string& word : words) connection >> word;
    const std::string& host = words[2];
    const std::string& ssh_port = words[3];
    const std::string_view user = environment("USER");
    return fmt::format("ssh {0}-N -L {1}:127.0.0.1:{1} {2}{3}{4}",
                       ssh_port.empty() || ssh_port == "22" ? "" : "-p " + ssh_port + " ", port, user,
                       user.empty() ? "" : "@", host.empty() ? "HOST" : host);
}

Browser::~Browser() {
    std::error_code ignored;
    if (!folder_.empty()) std::filesystem::remove_all(folder_, ignored);
}

bool Browser::open(const std::string& address) {
    if (environment("DISPLAY").empty() && environment("WAYLAND_DISPLAY").empty()) return false;
    if (folder_.empty()) folder_ = make_own_folder();
    if (folder_.empty()) return false;
    const std::string page = folder_ + "/view.html";
    if (!write_own_file(page, page_that_leads_to(address))) return false;
    posix_spawn_file_actions_t quiet;
    if (posix_spawn_file_actions_init(&quiet) != 0) return false;
    for (const int stream : {0, 1, 2}) posix_spawn_file_actions_addopen(&quiet, stream, "/dev/null", O_RDWR, 0);
    std::string program = "xdg-open", argument = "file://" + in_address(page);
    std::array<char*, 3> words{program.data(), argument.data(), nullptr};
    pid_t child = 0;
    const int failed = posix_spawnp(&child, "xdg-open", &quiet, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&quiet);
    return failed == 0; // xdg-open ends when the browser has the address; isotet does not wait for it
}

} // namespace isotet::cli
