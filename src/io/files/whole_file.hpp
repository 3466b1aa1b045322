// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A file as bytes in memory: what every reader of our own parses.
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "base/buffer.hpp"
#include "io/files/byte_source.hpp"
#include "base/system/plain_file.hpp"

namespace isotet::io {

/// A plain file, read into memory, or its beginning. Copies share the bytes.
///
/// Not mapped: a file that another program cuts short while it is mapped ends the process that looks at it (SIGBUS).
class WholeFile {
public:
    static constexpr std::size_t all = std::numeric_limits<std::size_t>::max();

    /// `most`   bytes from the beginning
    /// Errors   as core::open_plain_file(); file, when it was cut short meanwhile; out_of_memory, before memory is taken;
    ///          cancelled
    static Result<WholeFile> read(const std::string& path, const Progress& progress, std::size_t most = all);

    /// The whole file that begins so, of which only the rest is read.
    /// Errors   as read()
    static Result<WholeFile> read_rest(WholeFile begin, const std::string& path, const Progress& progress);

    bool is_whole() const noexcept { return whole_; }
    /// Shares the bytes.
    ByteSource source() const { return {text(), bytes_}; }
    std::string_view text() const noexcept { return {reinterpret_cast<const char*>(bytes_->data()), bytes_->size()}; }

private:
    WholeFile(std::shared_ptr<const core::Buffer<std::byte>> bytes, bool whole)
        : bytes_(std::move(bytes)), whole_(whole) {}
    static Result<WholeFile> read_behind(std::span<const std::byte> begin, const std::string& path,
                                         const Progress& progress, std::size_t most);

    std::shared_ptr<const core::Buffer<std::byte>> bytes_;
    bool whole_;
};

/// Fills `to` from byte `at` of an open file on, in parallel.
///
/// Errors   file: the file is shorter, or reading failed; cancelled
Result<void> read_bytes(const core::PlainFile& file, const std::string& path, std::span<std::byte> to,
                        const Progress& progress, std::size_t at = 0);

} // namespace isotet::io
