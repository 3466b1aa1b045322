// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/system/plain_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdint>
#include <limits>
#include <system_error>

#include <fmt/core.h>

namespace isotet::core {

Error system_error(const std::string& path, std::string_view what, int number) {
    const bool machine = number == ENOMEM || number == EMFILE || number == ENFILE || number == EIO;
    return {machine ? ErrorCode::system : ErrorCode::file,
            fmt::format("{}: {}: {}", path, what, std::generic_category().message(number))};
}

Result<PlainFile> open_plain_file(const std::string& path) {
    const auto not_a_file = [&](std::string_view kind) {
        return Error{ErrorCode::file, fmt::format("{} is {}, not a file", path, kind)};
    };
    if (path.find('\0') != std::string::npos) return Error{ErrorCode::file, "the path holds a NUL character"};

    // Looked at before it is opened: opening a device can do something, opening a pipe can wait for ever.
    struct stat status{};
    if (::stat(path.c_str(), &status) != 0) return system_error(path, "cannot be read", errno);
    if (const auto kind = what_else_than_a_file(status.st_mode); !kind.empty()) return not_a_file(kind);

    PlainFile file;
    file.descriptor = Descriptor(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (!file.descriptor) return system_error(path, "cannot be read", errno);
    if (::fstat(file.descriptor.number(), &status) != 0) return system_error(path, "cannot be read", errno);
    if (const auto kind = what_else_than_a_file(status.st_mode); !kind.empty()) return not_a_file(kind);
    if (status.st_size == 0) return Error{ErrorCode::file, fmt::format("{} is empty", path)};
    if (static_cast<std::uintmax_t>(status.st_size) > std::numeric_limits<std::size_t>::max() / 2) {
        return Error{ErrorCode::out_of_memory,
                     fmt::format("{} has {} bytes, more than can be addressed", path, status.st_size)};
    }
    file.size = static_cast<std::size_t>(status.st_size);
    return file;
}

Result<void> read_at(const PlainFile& file, const std::string& path, std::size_t at, std::span<std::byte> to) {
    while (!to.empty()) {
        const ssize_t count = ::pread(file.descriptor.number(), to.data(), to.size(), static_cast<off_t>(at));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return system_error(path, "cannot be read", errno);
        if (count == 0)
            return Error{ErrorCode::file,
                         fmt::format("{} was cut short while it was read: it had {} bytes", path, file.size)};
        to = to.subspan(static_cast<std::size_t>(count));
        at += static_cast<std::size_t>(count);
    }
    return {};
}

} // namespace isotet::core
