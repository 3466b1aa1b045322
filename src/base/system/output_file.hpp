// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The one checked stream through which isotet writes files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

#include "base/system/descriptor.hpp"

namespace isotet::core {

/// A file that appears under its name only when it is whole.
///
/// Bytes go to a new file in the same folder; commit() flushes it to the disk, checks it and renames it over `path`.
/// Until then, and for ever if anything fails or the OutputFile is destroyed, the old file stays as it was and the new
/// one is removed; where the file system has files without names (Linux's O_TMPFILE), also when the process is killed
/// before. Of a symbolic link the file that it points to is replaced; permission bits of an old file are kept.
///
/// After an error every later call returns the same error.
///
/// Errors   of all calls: invalid_argument: `path` is a folder or not a plain file; file: its folder does not exist;
///          machine: the disk is full, not writable and so on, with the path and the system's words
class ISOTET_API OutputFile {
public:
    static Result<OutputFile> open(const std::string& path);

    OutputFile(OutputFile&&) noexcept;
    OutputFile& operator=(OutputFile&&) noexcept;
    ~OutputFile();

    Result<void> write(std::span<const std::byte> bytes);
    Result<void> write(std::string_view text) { return write(std::as_bytes(std::span(text))); }
    /// Writes again over bytes that were written.
    Result<void> overwrite(std::uint64_t at, std::span<const std::byte> bytes);
    Result<void> commit();

    /// Bytes written so far.
    std::uint64_t bytes() const noexcept { return bytes_; }

private:
    OutputFile() = default;
    Result<void> flush();
    Result<void> write_through(std::span<const std::byte> bytes);
    bool give_name();
    Error fail(std::string_view what, int number);
    void discard() noexcept;
    void take_temporary_name(std::string name);
    void leave_temporary_name() noexcept;

    std::string path_;           ///< as the user gave it, for messages
    std::string name_;           ///< final name inside the folder
    std::string temporary_name_; ///< empty: nothing to remove, the file has no name yet
    Descriptor folder_;
    Descriptor file_;
    std::optional<unsigned> mode_; ///< permission bits of the old file
    std::unique_ptr<std::byte[]> buffer_;
    std::size_t buffered_ = 0;
    std::uint64_t bytes_ = 0;
    std::optional<Error> error_;
};

} // namespace isotet::core
