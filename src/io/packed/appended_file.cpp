// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/packed/appended_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include <fmt/core.h>

#include "io/packed/boundary_piece.hpp"
#include "io/packed/directory.hpp"
#include "io/packed/piece_reader.hpp"

namespace isotet::io {

namespace {

constexpr std::size_t append_buffer = std::size_t{1} << 20;

} // namespace

Error AppendedFile::failed(int number) const {
    return {ErrorCode::cannot_write,
            fmt::format("{}: cannot be written: {}", path_, std::generic_category().message(number))};
}

/// Whether the file of this name is still the one that is locked.
Result<void> AppendedFile::check_place() const {
    struct stat locked{}, named{};
    if (::fstat(file_.number(), &locked) != 0) return failed(errno);
    if (::stat(path_.c_str(), &named) == 0 && locked.st_dev == named.st_dev && locked.st_ino == named.st_ino) return {};
    return Error{ErrorCode::cannot_write,
                 fmt::format("{} was replaced or removed meanwhile: nothing was added to it", path_)};
}

Result<OpenedForAppending> AppendedFile::open(const std::string& path) {
    if (const Result<core::PlainFile> there = core::open_plain_file(path); !there)
        return there.error(); // before a pipe is opened
    OpenedForAppending opened{AppendedFile(), {}, {}};
    AppendedFile& file = opened.file;
    file.path_ = path;
    file.file_ = core::Descriptor(::open(path.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (!file.file_) return file.failed(errno);
    if (::flock(file.file_.number(), LOCK_EX | LOCK_NB) != 0) {
        if (errno != EWOULDBLOCK) return file.failed(errno);
        return Error{ErrorCode::cannot_write, fmt::format("{} is being written by another program", path)};
    }
    const auto source = PackedSource::open(path); // once it is locked
    if (!source) return source.error();
    if (auto same = file.check_place(); !same) return same.error(); // which `source` has opened then
    file.before_ = *source;
    file.next_slot_ = 1 - (*source)->slot_place;
    file.count_ = (*source)->slot.count;
    file.end_ = (*source)->slot.file_bytes;
    opened.directory = (*source)->directory;
    if (opened.directory.boundary) {
        Result<StoredBoundary> boundary = read_boundary(**source, 0);
        if (!boundary) return boundary.error();
        opened.boundary_points = std::move(boundary->points);
    }
    if (::ftruncate(file.file_.number(), static_cast<off_t>(file.end_)) != 0) return file.failed(errno);
    if (auto ok = file.write(std::vector<std::byte>(align_piece(file.end_) - file.end_)); !ok) return ok.error();
    return opened;
}

Result<void> AppendedFile::write_at(std::uint64_t at, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const auto written = ::pwrite(file_.number(), bytes.data(), bytes.size(), static_cast<off_t>(at));
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return failed(written == 0 ? ENOSPC : errno);
        bytes = bytes.subspan(static_cast<std::size_t>(written));
        at += static_cast<std::uint64_t>(written);
    }
    return {};
}

Result<void> AppendedFile::write(std::span<const std::byte> bytes) {
    buffered_.insert(buffered_.end(), bytes.begin(), bytes.end());
    if (buffered_.size() < append_buffer) return {};
    if (auto ok = write_at(end_, buffered_); !ok) return ok;
    end_ += buffered_.size();
    buffered_.clear();
    return {};
}

Result<void> AppendedFile::read(std::uint64_t at, std::span<std::byte> to) const { return before_->read(at, to); }

Result<void> AppendedFile::flush_to_disk() {
    while (::fsync(file_.number()) != 0) {
        if (errno == EINVAL || errno == ENOTSUP) break; // a file system that cannot
        if (errno != EINTR) return failed(errno);
    }
    return {};
}

Result<void> AppendedFile::commit(DirectorySlot slot) {
    if (auto same = check_place(); !same) return same;
    if (auto ok = write_at(end_, buffered_); !ok) return ok;
    end_ += buffered_.size();
    buffered_.clear();
    if (auto ok = flush_to_disk(); !ok) return ok;
    slot.count = count_ + 1;
    if (auto ok = write_at(packed_slots[next_slot_], encode_slot(slot)); !ok) return ok;
    return flush_to_disk();
}

} // namespace isotet::io
