// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/own/whole_file.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <new>

#include <unistd.h>

#include <fmt/format.h>

#include "core/memory.hpp"
#include "core/parallel.hpp"
#include "io/own/plain_file.hpp"

namespace isotet::io {

namespace {

constexpr std::size_t piece_bytes = std::size_t{4} << 20;
constexpr std::size_t many_bytes = std::size_t{64} << 20; ///< asking what is free takes longer than reading fewer

/// Returns 0, an errno, or `ended_early`.
constexpr int ended_early = -1;
int read_piece(int descriptor, std::span<std::byte> to, std::size_t at) {
    while (!to.empty()) {
        const ssize_t count = ::pread(descriptor, to.data(), to.size(), static_cast<off_t>(at));
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) return errno;
        if (count == 0) return ended_early;
        to = to.subspan(static_cast<std::size_t>(count));
        at += static_cast<std::size_t>(count);
    }
    return 0;
}

} // namespace

Result<void> read_bytes(int descriptor, const std::string& path, std::span<std::byte> to, const Progress& progress) {
    std::atomic<int> failure{0};
    core::parallel_pieces(to.size(), piece_bytes, progress, [&](std::size_t begin, std::size_t end) {
        if (const int failed = read_piece(descriptor, to.subspan(begin, end - begin), begin)) failure = failed;
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "reading was cancelled"};
    if (failure == ended_early)
        return Error{ErrorCode::file,
                     fmt::format("{} was cut short while it was read: it had {} bytes", path, to.size())};
    if (failure != 0) return system_error(path, "cannot be read", failure);
    return {};
}

Result<WholeFile> WholeFile::read(const std::string& path, const Progress& progress, std::size_t most) {
    const auto file = open_plain_file(path);
    if (!file) return file.error();
    const std::size_t size = std::min(file->size, most);
    if (size > many_bytes)
        if (auto fits = core::require_memory("reading " + path, size); !fits) return fits.error();
    try {
        core::Buffer<std::byte> bytes(size);
        auto done = read_bytes(file->descriptor.number(), path, {bytes.data(), bytes.size()}, progress);
        if (!done) return done.error();
        return WholeFile(std::make_shared<const core::Buffer<std::byte>>(std::move(bytes)));
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, "no memory left to read " + path};
    }
}

} // namespace isotet::io
