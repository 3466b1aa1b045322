// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include <isotet/read.hpp>

#include "io/files/whole_file.hpp"

namespace isotet {

/// A file that was read whole to be looked into, until it is read again: ReadOptions::kept.
///
/// Threads   safe from many threads
class KeptFiles {
public:
    /// Device, inode, size, and when its content was changed: seconds and nanoseconds.
    using Identity = std::array<std::uint64_t, 5>;

    /// Nothing where there is no such file.
    static std::optional<Identity> identity_of(const std::string& path);

    /// In place of one that was kept before. `identity`   before it was read
    void keep(const std::string& path, const Identity& identity, const io::WholeFile& file);

    /// Nothing where it was not kept, or changed since.
    std::optional<io::WholeFile> take(const std::string& path);

private:
    struct Kept {
        std::string path;
        Identity identity;
        io::WholeFile file;
    };
    std::mutex mutex_;
    std::optional<Kept> kept_;
};

namespace io {

/// A file for inspect(), which is kept for read() where `options` have a place for it.
/// Errors   as WholeFile::read()
Result<WholeFile> look_into_file(const std::string& path, const ReadOptions& options, const Progress& progress);

/// The file that look_into_file() kept, or reads it.
Result<WholeFile> take_file(const std::string& path, const ReadOptions& options, const Progress& progress);

} // namespace io
} // namespace isotet
