// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "output/standard_streams.hpp"

#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include <fmt/format.h>

namespace isotet::cli {

namespace {

bool stdout_closed_at_start = false;

/// 0, or the errno that ended the writing.
int write_all(int descriptor, std::string_view text) noexcept {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor, text.data(), text.size());
        if (written < 0) {
            if (errno == EINTR) continue;
            return errno;
        }
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return 0;
}

} // namespace

void open_missing_streams() {
    for (int descriptor = 0; descriptor <= 2; ++descriptor) {
        if (::fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
        if (descriptor == STDOUT_FILENO) stdout_closed_at_start = true;
        // The lowest free number is taken, and all lower ones are open by now.
        (void)::open("/dev/null", descriptor == STDIN_FILENO ? O_RDONLY : O_WRONLY);
    }
}

bool stdout_was_closed() noexcept { return stdout_closed_at_start; }

Result<void> write_to_stdout(std::string_view text) {
    if (const int error = write_all(STDOUT_FILENO, text)) {
        return Error{ErrorCode::cannot_write,
                     fmt::format("standard output cannot be written: {}", std::generic_category().message(error))};
    }
    return {};
}

void write_to_stderr(std::string_view text) noexcept { (void)write_all(STDERR_FILENO, text); }

bool stderr_is_terminal() noexcept { return ::isatty(STDERR_FILENO) == 1; }

} // namespace isotet::cli
