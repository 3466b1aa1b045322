// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which region of a grid the kept parts of a surface touch.
#pragma once

#include <optional>

#include <isotet/jobs/extract_files.hpp>

namespace isotet::jobs {

/// The region that PartChoice::region names; nothing where no region is asked for, or where isosurfaces are to touch
/// the grid's boundary, which no cell field tells.
///
/// Errors   invalid_argument: no region and no cell field has the name, or the values are no numbers that ascend
Result<std::optional<Region>> find_touched(const ExtractJob& job, const GridSource& source);

} // namespace isotet::jobs
