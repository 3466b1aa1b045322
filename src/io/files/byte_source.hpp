// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Bytes at positions, from a file or from memory: what readers take that fetch arrays out of large files.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

#include "base/buffer.hpp"
#include "base/system/plain_file.hpp"

namespace isotet::io {

/// Memory that grows and is used again, of one thread. Not cleared, not kept when it grows.
class Scratch {
public:
    std::span<std::byte> take(std::size_t bytes) {
        if (bytes > buffer_.size()) {
            buffer_.release();
            buffer_ = core::Buffer<std::byte>(bytes);
        }
        return {buffer_.data(), bytes};
    }

    /// Gives back what is too large to keep.
    void trim() noexcept {
        if (buffer_.size() > std::size_t{4} << 20) buffer_.release();
    }

private:
    core::Buffer<std::byte> buffer_;
};

/// A plain file, or text in memory. Copies share the file.
///
/// Not mapped: a file that another program cuts short while it is mapped ends the process that looks at it (SIGBUS).
/// Threads   safe from many threads
class ISOTET_API ByteSource {
public:
    /// Errors   as core::open_plain_file()
    static Result<ByteSource> open(const std::string& path);

    /// Borrows the text, or shares its owner.
    explicit ByteSource(std::string_view text) : text_(text), size_(text.size()) {}
    ByteSource(std::string_view text, std::shared_ptr<const void> owner)
        : text_(text), owner_(std::move(owner)), size_(text.size()) {}

    bool is_in_memory() const noexcept { return !file_; }

    std::size_t size() const noexcept { return size_; }

    /// Fills `to` with the bytes from `at` on.
    ///
    /// Errors   invalid_data: they lie behind the end; file: the file was cut short meanwhile; machine
    Result<void> read(std::size_t at, std::span<std::byte> to) const;

    /// The bytes from `at` on: those in memory, or those of the file, read into `scratch`.
    ///
    /// Errors   as read()
    Result<std::string_view> view(std::size_t at, std::size_t count, Scratch& scratch) const;

private:
    struct OpenFile {
        core::PlainFile file;
        std::string path;
    };

    ByteSource(std::shared_ptr<const OpenFile> file, std::size_t size) : file_(std::move(file)), size_(size) {}
    Result<void> check(std::size_t at, std::size_t count) const;

    std::shared_ptr<const OpenFile> file_; ///< or
    std::string_view text_;
    std::shared_ptr<const void> owner_; ///< of the text
    std::size_t size_;
};

} // namespace isotet::io
