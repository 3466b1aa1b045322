// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Temporary file, checked writes, fsync, rename.
#include "base/system/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "base/system/unfinished_files.hpp"

namespace isotet::core {
namespace {

constexpr std::size_t buffer_size = std::size_t{1} << 20;
constexpr std::size_t largest_write = std::size_t{1} << 30; // the kernel takes at most 2 GiB at once
constexpr int max_links = 40;                               // as many as the kernel follows
constexpr int max_names = 10000;

Error write_error(std::string_view path, std::string_view what, int number) {
    // Who has to act: a path that cannot be is the caller's business, all else the machine's.
    const bool path_is_wrong = number == ENOENT || number == ENOTDIR || number == ENAMETOOLONG || number == ELOOP;
    return {path_is_wrong ? ErrorCode::file : ErrorCode::cannot_write,
            fmt::format("{}: {}: {}", path, what, std::generic_category().message(number))};
}

/// The last part of a path and the folder it lies in ("." where none is named).
std::pair<std::string, std::string> split_path(const std::string& path) {
    const auto slash = path.rfind('/');
    if (slash == std::string::npos) return {".", path};
    return {slash == 0 ? "/" : path.substr(0, slash), path.substr(slash + 1)};
}

/// Follows symbolic links by hand, because the file at the end need not exist yet.
Result<std::string> follow_links(const std::string& path) {
    std::string current = path;
    for (int i = 0; i < max_links; ++i) {
        struct stat status{};
        if (::lstat(current.c_str(), &status) != 0) {
            if (errno == ENOENT) return current;
            return write_error(path, "cannot be written", errno);
        }
        if (!S_ISLNK(status.st_mode)) return current;
        char target[PATH_MAX];
        const auto length = ::readlink(current.c_str(), target, sizeof target);
        if (length < 0) return write_error(path, "cannot be written", errno);
        const std::string next(target, static_cast<std::size_t>(length));
        current = next.starts_with('/') ? next : split_path(current).first + "/" + next;
    }
    return write_error(path, "cannot be written", ELOOP);
}

constexpr const char* own_files = "/proc/self/fd";

std::string temporary_name() {
    static std::atomic<unsigned> counter{0};
    return fmt::format(".isotet-{}-{}.part", ::getpid(), counter++);
}

} // namespace

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_)),
      name_(std::move(other.name_)),
      temporary_name_(std::exchange(other.temporary_name_, {})),
      folder_(std::move(other.folder_)),
      file_(std::move(other.file_)),
      mode_(other.mode_),
      buffer_(std::move(other.buffer_)),
      buffered_(std::exchange(other.buffered_, 0)),
      bytes_(other.bytes_),
      error_(std::move(other.error_)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
    if (this != &other) {
        discard();
        path_ = std::move(other.path_);
        name_ = std::move(other.name_);
        temporary_name_ = std::exchange(other.temporary_name_, {});
        folder_ = std::move(other.folder_);
        file_ = std::move(other.file_);
        mode_ = other.mode_;
        buffer_ = std::move(other.buffer_);
        buffered_ = std::exchange(other.buffered_, 0);
        bytes_ = other.bytes_;
        error_ = std::move(other.error_);
    }
    return *this;
}

OutputFile::~OutputFile() { discard(); }

Result<OutputFile> OutputFile::open(const std::string& path) {
    if (path.empty()) return Error{ErrorCode::invalid_argument, "the name of the file to write is empty"};
    if (path.find('\0') != std::string::npos) {
        return Error{ErrorCode::invalid_argument, "the name of the file to write holds a NUL character"};
    }
    OutputFile out;
    out.path_ = path;

    // stat() first: it sees through links that only the kernel can follow, as /dev/stdout may be.
    struct stat status{};
    if (::stat(path.c_str(), &status) == 0) {
        if (const auto kind = what_else_than_a_file(status.st_mode); !kind.empty()) {
            return Error{ErrorCode::invalid_argument,
                         fmt::format("{} is {}: only a plain file can be written", path, kind)};
        }
        if (::faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0) {
            return write_error(path, "cannot be overwritten", errno);
        }
        out.mode_ = status.st_mode & 0777U;
    } else if (errno != ENOENT) {
        return write_error(path, "cannot be written", errno);
    }
    auto target = follow_links(path);
    if (!target) return target.error();
    auto [folder, name] = split_path(*target);
    if (name.empty() || name == "." || name == "..") {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("{} is a folder: only a plain file can be written", path)};
    }
    out.name_ = std::move(name);
    out.folder_ = Descriptor(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (!out.folder_ && errno == EACCES)
        out.folder_ = Descriptor(::open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    if (!out.folder_) return write_error(path, fmt::format("cannot write in the folder {}", folder), errno);

    // An old file's content may be private: the new one must not be readable by others before it has the same permissions.
    const mode_t mode = out.mode_ ? 0600 : 0666;
    // A file without a name is gone when this process is killed; it gets one through /proc.
    if (::access(own_files, X_OK) == 0)
        out.file_ = Descriptor(::openat(out.folder_.number(), ".", O_WRONLY | O_TMPFILE | O_CLOEXEC, mode));
    for (int i = 0; i < max_names && !out.file_; ++i) {
        std::string candidate = temporary_name();
        out.file_ = Descriptor(
            ::openat(out.folder_.number(), candidate.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode));
        if (out.file_) out.take_temporary_name(std::move(candidate));
        else if (errno != EEXIST) break;
    }
    if (!out.file_) return write_error(path, fmt::format("cannot write in the folder {}", folder), errno);
    out.buffer_ = std::make_unique_for_overwrite<std::byte[]>(buffer_size);
    return out;
}

Result<void> OutputFile::write(std::span<const std::byte> bytes) {
    if (error_) return *error_;
    if (bytes.empty()) return {};
    bytes_ += bytes.size();
    if (bytes.size() > buffer_size - buffered_) {
        if (auto flushed = flush(); !flushed) return flushed;
        if (bytes.size() >= buffer_size) return write_through(bytes);
    }
    std::memcpy(buffer_.get() + buffered_, bytes.data(), bytes.size());
    buffered_ += bytes.size();
    return {};
}

Result<void> OutputFile::flush() { return write_through({buffer_.get(), std::exchange(buffered_, 0)}); }

Result<void> OutputFile::write_through(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const auto written = ::write(file_.number(), bytes.data(), std::min(bytes.size(), largest_write));
        if (written > 0) bytes = bytes.subspan(static_cast<std::size_t>(written));
        else if (written == 0) return fail("cannot be written", ENOSPC);
        else if (errno != EINTR) return fail("cannot be written", errno);
    }
    return {};
}

Result<void> OutputFile::overwrite(std::uint64_t at, std::span<const std::byte> bytes) {
    if (error_) return *error_;
    if (auto flushed = flush(); !flushed) return flushed;
    while (!bytes.empty()) {
        const auto written = ::pwrite(file_.number(), bytes.data(), bytes.size(), static_cast<off_t>(at));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return fail("cannot be written", written == 0 ? ENOSPC : errno);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
        at += static_cast<std::uint64_t>(written);
    }
    return {};
}

Result<void> OutputFile::commit() {
    if (error_) return *error_;
    if (!file_) return Error{ErrorCode::internal, fmt::format("{} was committed twice", path_)};
    if (auto flushed = flush(); !flushed) return flushed;
    if (mode_ && ::fchmod(file_.number(), *mode_) != 0) return fail("cannot be given its permissions", errno);
    while (::fsync(file_.number()) != 0) {
        if (errno == EINVAL || errno == ENOTSUP) break; // a file system that cannot
        if (errno != EINTR) return fail("cannot be flushed to the disk", errno);
    }
    if (temporary_name_.empty() && !give_name()) return fail("cannot be given a name", errno);
    // Some file systems find out only here that the disk is full.
    if (::close(file_.release()) != 0 && errno != EINTR) return fail("cannot be closed", errno);
    if (::renameat(folder_.number(), temporary_name_.c_str(), folder_.number(), name_.c_str()) != 0) {
        return fail("cannot be replaced", errno);
    }
    leave_temporary_name();
    // The new name, too, should survive a power cut; where a folder cannot be synced it need not.
    ::fsync(folder_.number());
    return {};
}

bool OutputFile::give_name() {
    const std::string itself = fmt::format("{}/{}", own_files, file_.number());
    for (int i = 0; i < max_names && temporary_name_.empty(); ++i) {
        std::string candidate = temporary_name();
        if (::linkat(AT_FDCWD, itself.c_str(), folder_.number(), candidate.c_str(), AT_SYMLINK_FOLLOW) == 0)
            take_temporary_name(std::move(candidate));
        else if (errno != EEXIST) return false;
    }
    return !temporary_name_.empty();
}

Error OutputFile::fail(std::string_view what, int number) {
    discard();
    error_ = write_error(path_, what, number);
    return *error_;
}

void OutputFile::discard() noexcept {
    file_.reset();
    if (!temporary_name_.empty()) ::unlinkat(folder_.number(), temporary_name_.c_str(), 0);
    leave_temporary_name();
}

void OutputFile::take_temporary_name(std::string name) {
    temporary_name_ = std::move(name);
    note_unfinished_file(folder_.number(), temporary_name_);
}

void OutputFile::leave_temporary_name() noexcept {
    if (!temporary_name_.empty()) forget_unfinished_file(folder_.number(), temporary_name_);
    temporary_name_.clear();
}

} // namespace isotet::core
