// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include <isotet/read.hpp>

#include "io/files/byte_source.hpp"
#include "io/files/whole_file.hpp"

namespace isotet {

/// What looking at a grid read of its files, whole or their beginnings, until they are read again: ReadOptions::kept.
///
/// Threads   safe from many threads
class KeptFiles {
public:
    /// Device, inode, size, and when its content was changed: seconds and nanoseconds.
    using Identity = std::array<std::uint64_t, 5>;

    /// Nothing where there is no such file.
    static std::optional<Identity> identity_of(const std::string& path);

    /// From here on files of this grid are looked into; those of another are forgotten.
    void look_at(const std::string& grid);

    /// In place of what was kept of it before. `identity`   before it was read
    void keep(const std::string& path, const Identity& identity, const io::WholeFile& file);

    /// Room for a file that need not be kept. False where there is none beside what is kept and reserved.
    bool reserve(std::size_t bytes);
    /// What was reserved is kept now, or not needed.
    void release(std::size_t bytes);
    /// Forgets all files.
    void forget();

    /// Nothing where it was not kept, or changed since.
    std::optional<io::WholeFile> get(const std::string& path) const;
    std::optional<io::WholeFile> take(const std::string& path);

private:
    struct Kept {
        Identity identity;
        io::WholeFile file;
    };
    mutable std::mutex mutex_;
    std::string grid_;
    std::map<std::string, Kept> kept_;
    std::size_t bytes_ = 0; ///< of all of them
    std::size_t reserved_ = 0;
};

namespace io {

/// A file for inspect(), or its first bytes, which are kept for read() where `options` have a place for them.
/// Errors   as WholeFile::read()
Result<WholeFile> look_into_file(const std::string& path, const ReadOptions& options, const Progress& progress,
                                 std::size_t most = WholeFile::all);

/// A file of which readers fetch parts: in memory and kept, where `options` have room for it, if it is small or
/// `goes_by()` says of its first bytes that all of it is gone through anyhow; else open.
/// Errors   as ByteSource::open(), WholeFile::read()
Result<ByteSource> open_source(const std::string& path, const ReadOptions& options, const Progress& progress,
                               bool (*goes_by)(std::string_view head));

/// The whole file, of which what look_into_file() kept is not read again.
Result<WholeFile> take_file(const std::string& path, const ReadOptions& options, const Progress& progress);

} // namespace io
} // namespace isotet
