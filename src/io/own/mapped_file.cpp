// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Opens and maps a whole file.
#include "io/own/mapped_file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdint>
#include <limits>
#include <new>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "io/own/file_kind.hpp"

namespace isotet::io {
namespace {

Error system_error(const std::string& path, std::string_view what, int number) {
    const bool machine = number == ENOMEM || number == EMFILE || number == ENFILE || number == EIO;
    return {machine ? ErrorCode::machine : ErrorCode::file,
            fmt::format("{}: {}: {}", path, what, std::generic_category().message(number))};
}

Error not_a_file(const std::string& path, std::string_view kind) {
    return {ErrorCode::file, fmt::format("{} is {}, not a file", path, kind)};
}

} // namespace

Result<MappedFile> MappedFile::open(const std::string& path) {
    if (path.find('\0') != std::string::npos) return Error{ErrorCode::file, "the path holds a NUL character"};

    // Looked at before it is opened: opening a device can do something, opening a pipe can wait for ever.
    struct stat status{};
    if (::stat(path.c_str(), &status) != 0) return system_error(path, "cannot be read", errno);
    if (const auto kind = what_else_than_a_file(status.st_mode); !kind.empty()) return not_a_file(path, kind);

    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (!file) return system_error(path, "cannot be read", errno);
    if (::fstat(file.number(), &status) != 0) return system_error(path, "cannot be read", errno);
    if (const auto kind = what_else_than_a_file(status.st_mode); !kind.empty()) return not_a_file(path, kind);
    if (status.st_size == 0) return Error{ErrorCode::file, fmt::format("{} is empty", path)};
    if (static_cast<std::uintmax_t>(status.st_size) > std::numeric_limits<std::size_t>::max() / 2) {
        return Error{ErrorCode::out_of_memory,
                     fmt::format("{} has {} bytes, more than can be addressed", path, status.st_size)};
    }

    const auto size = static_cast<std::size_t>(status.st_size);
    void* const data = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.number(), 0);
    if (data == MAP_FAILED) return system_error(path, "cannot be mapped into memory", errno);
    ::madvise(data, size, MADV_SEQUENTIAL);
    try {
        return MappedFile(std::shared_ptr<const void>(data, [size](void* mapped) { ::munmap(mapped, size); }), size);
    } catch (const std::bad_alloc&) { // shared_ptr has called the deleter
        return Error{ErrorCode::out_of_memory, "no memory left to open a file"};
    }
}

} // namespace isotet::io
