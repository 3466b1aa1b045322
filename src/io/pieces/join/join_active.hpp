// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/pieces/loaded.hpp"

namespace isotet::io {

/// Joins pieces whose cells are not read yet to a grid of all points and the active cells (ReadOptions::active_cells).
///
/// Guarantees   points, their numbers and fields, notes and the order of cells are those of join() with all cells
/// Errors       as join() and CellSource
/// Cost         memory for the points of the pieces and of the grid, and for active cells; one pass over all cells, two
///              over those of pieces with ghost cells, and over all where some points are in no cell
/// `begun`      what the result is to begin with; its notes come first
/// `may_free`   points and fields of the pieces may be freed before the cells go by
/// Returns nothing where all cells are needed, and leaves the pieces as they were; none where they were freed
Result<std::optional<ReadResult>> join_active(std::vector<Piece>& pieces, const ReadResult& begun,
                                              const ReadOptions& options, const Progress& progress, bool may_free);

/// The same of counts and a sample of the cells (read_surveyed()), with cell fields of all that are kept.
/// `counted`   gets report and numbers of the sample
Result<std::optional<ReadResult>> join_counted(std::vector<Piece>& pieces, const ReadResult& begun,
                                               const ReadOptions& options, const Progress& progress,
                                               SurveyedGrid& counted);

} // namespace isotet::io
