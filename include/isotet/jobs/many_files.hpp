// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Several files that are grids of their own, in place of time steps of one.
#pragma once

#include <string>
#include <vector>

#include <isotet/jobs/extract_files.hpp>

namespace isotet::jobs {

/// Whether the names of all files differ in their numbers alone, as those of time steps do. True for one file.
bool are_time_steps(const GridOptions& grid);

/// The options for each file by itself, in their order.
std::vector<GridOptions> each_file(const GridOptions& grid);

/// True where {name} stands in ExtractJob::out: each file has surfaces of its own.
bool names_each_file(const ExtractJob& job);

/// The job for each file by itself: {name} in `out` and `parts_table` is the name of the file without folder and ending.
/// Errors   invalid_argument: two files have the same name, so that one output would overwrite the other; an output is one of
///          the files, or cannot be written
Result<std::vector<ExtractJob>> job_for_each_file(const ExtractJob& job);

} // namespace isotet::jobs
