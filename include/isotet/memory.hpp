// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// Returns memory that isotet keeps for its next call to the system: large arrays that were given back, at most 1/64 of
/// the machine's memory. Worth a call before the program does something else for long.
/// What the C library keeps of freed memory goes back as well, where it can.
/// Threads that wait for the next call are given back to oneTBB, too, so that tbb::finalize() may succeed.
///
/// Returns      how many bytes isotet kept; 0 also when there was no memory for that
/// Guarantees   nothing that an object of yours holds is touched
/// Threads      safe from many threads, also while operations run
ISOTET_API std::size_t release_memory() noexcept;

// Memory of this process, as the system counts it.

/// Bytes of this process that are in the machine's memory: now, and at most since the process began or
/// reset_peak_memory() was called. Nothing where the system does not tell.
/// Threads   safe from many threads
ISOTET_API std::optional<std::uint64_t> resident_memory();
ISOTET_API std::optional<std::uint64_t> peak_resident_memory();

/// Resets the peak-memory counter of the process; false where the system cannot.
ISOTET_API bool reset_peak_memory();

// Large arrays in files of a folder, for grids whose packing does not fit into memory.

struct ScratchOptions {
    std::string folder;       ///< on a disk: a folder that is itself memory gains nothing
    std::uint64_t memory = 0; ///< bytes of the machine's memory that the process aims to stay below
};

/// What lies in files.
struct ScratchReport {
    std::uint64_t bytes = 0, peak_bytes = 0; ///< now, at most
};

/// While one lives, all arrays that isotet makes in this process (grids that are read or made, packed grids, what
/// packing needs) lie in files of a folder where they would take more memory than is wanted: three eighths of
/// `memory` are for arrays, a quarter for those of a sixty-fourth or more, a sixteenth at most for one. Pages of the
/// files that are in memory are let go of when the process comes near `memory`; the system keeps what of them it has
/// room for in its cache, and writes the rest. Results are the same.
///
/// The files have no names: nothing of them stays when the process ends, however it does. Their room is asked of the
/// file system before they are written to. An array that lies in a file does so until it is destroyed, also after the
/// ScratchMemory is. What is not an array of isotet's, such as the caller's, is not moved; when that alone takes more
/// than `memory`, the process does. The replies of isotet-reader are not moved either. A process that fork() makes shares
/// the files: it may only exec(). On file systems that do not keep room for files (ZFS) a full disk ends the process.
///
/// Threads   safe from many threads; one at a time in a process
class ISOTET_API ScratchMemory {
public:
    /// Errors   invalid_argument: another one lives, or `memory` is 0; cannot_write: no file can be made in the folder
    static Result<ScratchMemory> begin(const ScratchOptions& options);

    ScratchMemory(ScratchMemory&&) noexcept;
    ScratchMemory& operator=(ScratchMemory&&) noexcept;
    ~ScratchMemory();

    ScratchReport report() const;

    /// An error when the file system has no room for so many bytes: "packing needs 3 GB in the scratch folder
    /// '/data', but 2 GB are free".
    Result<void> require(std::string_view what, std::uint64_t bytes) const;

    /// Why an array could not be had of the folder, if that happened: then what asked for it ends with out_of_memory.
    std::optional<Error> failure() const;

private:
    struct Data;
    explicit ScratchMemory(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

} // namespace isotet
