// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The grid, packed, in a page of one file, with isotet as WebAssembly.
#pragma once

#include <optional>

#include <isotet/result.hpp>

#include "view/export/export_page.hpp"
#include "view/note_keeper.hpp"

namespace isotet::view {

/// Nothing: the content is to be what fits, and that is isosurfaces; a note says why. Errors   as export_page()
Result<std::optional<ExportNumbers>> export_grid(const ExportJob& job, NoteKeeper& caller);

/// No file of the grid may be written.
Result<void> check_export_paths(const ExportJob& job, const jobs::GridSource& source);

} // namespace isotet::view
