// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What info tells of a file, without all of its cells in memory.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// A grid that was read to be counted.
struct SurveyedGrid {
    ReadResult read; ///< where there is a report, with a sample of the cells, and cell fields of all of them
    std::optional<GridReport> report = {};   ///< survey() of all cells, without faces; nothing: the grid has all cells
    std::vector<std::uint64_t> sampled = {}; ///< numbers of the cells of the sample
};

/// read(), but cells are counted as they go by, and only a sample of them is kept, where that can be done: linear cells in
/// VTK's XML formats, VTKHDF, Exodus or a binary legacy VTK file, of which no piece repeats some of another but as ghost cells,
/// and points that do not coincide.
///
/// Cost     of such a file memory for points and fields, a byte a point, and one pass over the cells
/// Errors   as read()
ISOTET_API Result<SurveyedGrid> read_surveyed(const std::string& path, const ReadOptions& options = {},
                                              const Run& run = {});

} // namespace isotet
