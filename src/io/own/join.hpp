// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <isotet/export.hpp>

#include "io/own/loaded.hpp"

namespace isotet::io {

/// Makes one grid of all pieces, one after another.
///
/// Points are joined by their global numbers where every piece has them (and equal numbers mean equal places), else by
/// exactly equal coordinates of different pieces if `by_coordinates`, else not at all. Left-out cells and cells whose
/// global number an earlier piece had are dropped. A field that only some pieces have is NaN elsewhere. All of this is
/// told in notes. A single piece without left-out cells is passed on without a copy.
///
/// Errors   invalid_data when arrays do not fit together or a cell has a point out of range
/// Cost     O(P + T); frees each piece's arrays once they are joined
ISOTET_API Result<ReadResult> join(Loaded loaded, bool by_coordinates);

} // namespace isotet::io
