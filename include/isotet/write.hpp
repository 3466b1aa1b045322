// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet {

// Files that are whole or not there, for what isotet does not write itself: reports, tables, indexes.

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

struct WriteReport {
    std::uint64_t bytes = 0;
    std::vector<std::string> notes; ///< what the format could not hold
};

/// How arrays of vtp and vtu are packed, in blocks that are packed and can be unpacked in parallel.
enum class Compression : std::uint8_t {
    none,
    zlib, ///< every version of VTK reads it
    lz4   ///< larger, and read faster; VTK 8 and later
};

/// "none", "zlib", "lz4".
ISOTET_API std::string_view name_of(Compression compression) noexcept;

/// A cell field of times: GLB shows what has one of them after the other.
inline constexpr std::string_view animation_field = "animation_time";

struct WriteOptions {
    std::string format = {}; ///< "vtp", "ply" and so on; empty: from the ending of the path
    Compression compression =
        Compression::none; ///< of vtp and vtu; takes memory for the file. Its bytes are those of the
                           ///< installed libdeflate or LZ4: another version may pack otherwise
    std::vector<Field> field_data =
        {}; ///< arrays of a surface's file as a whole, in vtp and vtk; read_surface() returns those whose names begin with
            ///< "isotet:"
};

/// Writes a surface: vtp, ply, stl, 3mf, obj, glb, usda, vtk (legacy), ts (Gocad TSurf); the format from the ending of
/// `path` unless the options name one.
///
/// The file is written beside `path` under another name, flushed, checked, and renamed: at every moment `path` is the
/// old file or the whole new one. Nothing in the file differs between runs. A symbolic link stays: what it points to is
/// replaced. Permission bits of an old file are kept.
///
/// Errors   invalid_argument: unknown format, one that has no compression where one is asked for, arrays that do not fit
///          together, `path` is a folder or not a plain file;
///          invalid_data: a triangle with a vertex that is not there; file: the folder of `path` is not there;
///          cannot_write: disk full, not writable; out_of_memory; cancelled
ISOTET_API Result<WriteReport> write_surface(const Surface& surface, const std::string& path,
                                             const WriteOptions& options = {}, const Run& run = {});

/// Writes a grid: vtu (raw appended; polyhedra with their faces), vtk (legacy binary; no polyhedra); the same guarantees.
ISOTET_API Result<WriteReport> write_grid(const Grid& grid, const std::string& path, const WriteOptions& options = {},
                                          const Run& run = {});

} // namespace isotet
