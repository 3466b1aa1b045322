// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files that are whole or not there, for what isotet does not write itself: reports, tables, indexes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// Writes a text as a file, with the guarantees of write_surface(): written beside `path`, flushed, renamed.
///
/// Errors   invalid_argument: `path` is a folder or not a plain file; file: its folder is not there; cannot_write:
///          disk full, not writable; cancelled. The old file is then as before
ISOTET_API Result<void> write_text(std::string_view text, const std::string& path, const Run& run = {});

/// Whether a file could be written: creates one beside `path` and removes it again. To be called before long work.
/// Errors   as write_text()
ISOTET_API Result<void> check_writable(const std::string& path);

/// Removes what is being written and not whole, in all threads: for a signal handler that ends the program. A signal
/// handler may call it.
ISOTET_API void remove_unfinished_files() noexcept;

/// A file of a series, and when it is.
struct CollectionEntry {
    double time = 0;
    std::size_t part = 0; ///< of several files of one time: 0, 1, 2 and so on
    std::string file;     ///< its name, absolute or as `path` of write_collection()
};

/// Writes a ParaView collection (.pvd): an index by which a series of VTK XML files opens as one data set with times.
/// Files below the folder of `path` are named relative to it, so that the folder can be moved. A `path` that ends in
/// .usda is a stage of USD that shows USD files one after another, four times a second.
///
/// Errors   as write_text()
ISOTET_API Result<void> write_collection(const std::vector<CollectionEntry>& entries, const std::string& path,
                              const Run& run = {});

/// Whether a file begins as those that write_collection() writes. Other programs' begin otherwise.
ISOTET_API bool is_written_collection(const std::string& path);

} // namespace isotet
