// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a grid reader is to isotet::read(): a format and two functions. src/io/read.cpp picks one by content, then name.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/read.hpp>

namespace isotet::io {

/// The file of one step of an index by time, which another reader reads.
struct FileOfTime {
    std::string path;
    std::vector<double> times; ///< of all steps
    std::vector<std::string> files, notes;
};

/// One grid format. `recognizes` sees the first bytes of the file (up to 4 KiB) and its lower-case extension (".vtu").
struct GridReader {
    Format format;
    /// 0: no; 1: by the name only; 2: by the content.
    int (*recognizes)(std::string_view head, std::string_view extension);
    Result<FileInfo> (*inspect)(const std::string& path, const ReadOptions& options, const Progress& progress);
    /// Returns arrays as the file has them; isotet::read() checks shapes and index ranges afterwards.
    Result<ReadResult> (*read)(const std::string& path, const ReadOptions& options, const Progress& progress);
    /// read_surveyed(); null: as read(), or by its pieces.
    Result<SurveyedGrid> (*survey)(const std::string& path, const ReadOptions& options,
                                   const Progress& progress) = nullptr;
    /// Of an index by time; nothing where `read` reads the step itself. Null: it is none.
    Result<std::optional<FileOfTime>> (*file_of_time)(const std::string& path, const ReadOptions& options,
                                                      const Progress& progress) = nullptr;
};

/// Readers that are always there.
std::span<const GridReader> own_readers();

/// Those whose files the program isotet-reader reads: with ISOTET_IO only.
std::span<const GridReader> confined_readers();

/// True when `options` ask for the field; other fields are not read.
ISOTET_API bool wanted(const ReadOptions& options, Association association, std::string_view name);

/// The step that `options` ask for: the first if they do not say.
///
/// Errors   invalid_argument, with the number of steps, when there is no such step
ISOTET_API Result<std::size_t> choose_step(const FileInfo& info, const ReadOptions& options);

} // namespace isotet::io
