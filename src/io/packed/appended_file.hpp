// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Writing behind what a packed file holds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <isotet/result.hpp>

#include "base/system/descriptor.hpp"
#include "io/packed/format.hpp"
#include "io/packed/piece_reader.hpp"

namespace isotet::io {

struct OpenedForAppending;

/// What is written does not count before commit(): the valid slot of the header tells of the old directory until then.
class AppendedFile {
public:
    /// Locks the file, and cuts off what a writer that did not finish left.
    /// Errors   as PackedSource::open(); cannot_write: another writer has it, it cannot be written, or another file took its
    ///          place meanwhile
    static Result<OpenedForAppending> open(const std::string& path);

    Result<void> write(std::span<const std::byte> bytes);
    /// What was there when it was opened.
    Result<void> read(std::uint64_t at, std::span<std::byte> to) const;
    std::uint64_t bytes() const noexcept { return end_ + buffered_.size(); } ///< of the file so far

    /// All is on the disk before the other slot is written.
    /// Errors   cannot_write, also where another file has taken its place
    Result<void> commit(DirectorySlot slot);

private:
    AppendedFile() = default;
    Result<void> write_at(std::uint64_t at, std::span<const std::byte> bytes);
    Result<void> flush_to_disk();
    Error failed(int number) const;
    Result<void> check_place() const;

    std::string path_;
    core::Descriptor file_;
    std::shared_ptr<const PackedSource> before_;
    std::uint64_t end_ = 0;
    std::vector<std::byte> buffered_;
    std::size_t next_slot_ = 0; ///< the one that does not hold
    std::uint64_t count_ = 0;   ///< directories so far
};

struct OpenedForAppending {
    AppendedFile file;
    PackedDirectory directory;
    std::vector<std::uint64_t> boundary_points; ///< packed ones, where the file has the boundary
};

} // namespace isotet::io
