// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <isotet/export.hpp>
#include <isotet/read.hpp>

#include "io/grdecl/deck.hpp"
#include "io/reader.hpp"

namespace isotet::io {

/// Corner-point grids of reservoir simulators, as text: SPECGRID or DIMENS, COORD, ZCORN, ACTNUM, MAPAXES, and every
/// list of as many numbers as there are cells as a cell field. Faults stay open: grdecl/corner_points.hpp.
GridReader grdecl_reader();

/// Errors   invalid_data: a list that is missing, cut short or of a wrong length, words that are no numbers;
///          out_of_memory, before memory is taken; those of `open`; cancelled
ISOTET_API Result<FileInfo> inspect_grdecl(const grdecl::DeckText& text, const grdecl::OpenIncluded& open,
                                           const Progress& progress);
ISOTET_API Result<ReadResult> parse_grdecl(const grdecl::DeckText& text, const grdecl::OpenIncluded& open,
                                           const ReadOptions& options, const Progress& progress);

} // namespace isotet::io
