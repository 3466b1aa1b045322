// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/read.hpp>

#include "io/pieces/loaded.hpp"

namespace isotet::io {

/// Makes one grid of all pieces, cells one piece after another.
///
/// Points are joined as find_seams() says, unless they are to be kept apart (ReadOptions::merge_pieces_by_coordinates).
/// Left-out cells are dropped, and so are cells that an earlier piece has. A field that only some
/// pieces have is NaN elsewhere. All of this is told in notes. A single piece without left-out cells is passed on
/// without a copy. Where points are joined, they are numbered by pieces in the order of their boxes: surfaces do not
/// depend on the order in which a file names its pieces.
///
/// Errors   invalid_data when arrays do not fit together or a cell has a point out of range; out_of_memory; cancelled
/// Cost     O(P + T) and what find_seams() takes; frees each piece's arrays once they are joined
ISOTET_API Result<ReadResult> join(Loaded loaded, const ReadOptions& options, const Progress& progress = {});

/// join() of what `load` gives. Where only active cells are wanted, points and fields of the pieces are freed before their
/// cells go by, and loaded once more in the rare case that these call for them.
ISOTET_API Result<ReadResult> load_and_join(const std::function<Result<Loaded>()>& load, const ReadOptions& options,
                                            const Progress& progress = {});

/// join() for read_surveyed(): with a sample of the cells where they can be counted as they go by.
/// `options`   of to_be_counted()
ISOTET_API Result<SurveyedGrid> join_counted(Loaded loaded, const ReadOptions& options, const Progress& progress = {});

} // namespace isotet::io
