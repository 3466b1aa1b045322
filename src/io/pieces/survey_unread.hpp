// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/read_surveyed.hpp>
#include <isotet/result.hpp>

#include "io/pieces/loaded.hpp"

namespace isotet::io {

/// What reads for survey_unread(): cells stay in the file, whatever fields there are.
inline ReadOptions to_be_counted(ReadOptions options) {
    options.active_cells.emplace(); // of no isovalue
    return options;
}
inline bool are_counted(const ReadOptions& options) {
    return options.active_cells && options.active_cells->isovalues.empty();
}

/// Counts the cells of a piece that are not read yet, and keeps a sample of them (read_surveyed()).
///
/// Returns nothing where all cells are needed: cells are left out or broken, points may coincide, there are cell fields beside
/// cells without a volume, or there are options that change points or choose cells
/// Errors       as CellSource; cancelled
/// Cost         one pass over the cells, a byte a point
Result<std::optional<SurveyedGrid>> survey_unread(const Piece& piece, const ReadOptions& options, const Progress& progress);

} // namespace isotet::io
