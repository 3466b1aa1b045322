// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A whole file as bytes in memory, mapped and not copied: for looks at files in the reader process.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include <isotet/result.hpp>

namespace isotet::io {

/// A plain file, mapped read only. Copies share the mapping, which lives as long as the last copy or owner().
///
/// Pages are taken from the system's cache, so a file larger than the free memory can be mapped. A file that another
/// program cuts short while it is mapped ends this process (SIGBUS), which its parent then reports.
class MappedFile {
public:
    /// Errors   as core::open_plain_file(); machine: mapping failed
    static Result<MappedFile> open(const std::string& path);

    std::span<const std::byte> bytes() const noexcept { return {static_cast<const std::byte*>(data_.get()), size_}; }
    std::string_view text() const noexcept { return {static_cast<const char*>(data_.get()), size_}; }

    /// Keeps the mapping alive: for an Array that is a view into the file.
    std::shared_ptr<const void> owner() const noexcept { return data_; }

private:
    MappedFile(std::shared_ptr<const void> data, std::size_t size) : data_(std::move(data)), size_(size) {}

    std::shared_ptr<const void> data_;
    std::size_t size_ = 0;
};

} // namespace isotet::io
