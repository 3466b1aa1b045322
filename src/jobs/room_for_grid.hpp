// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Whether a grid fits into memory, before the first of its arrays is read.
#pragma once

#include <cstdint>
#include <string>

#include <isotet/jobs/grid_source.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::jobs {

/// Bytes of what is in memory once a grid has been read: at least.
struct GridBytes {
    std::uint64_t points = 0, cells = 0, values = 0;
};

/// `all_cells`   false: those that isovalues cut, and their cell fields, are read alone, where the format can
GridBytes least_bytes_of(const FileInfo& info, const FieldsToRead& fields, bool all_cells);

/// Errors   out_of_memory: "reading FILE needs 12.3 GB: 1.2 GB for points, ..., but 4.5 GB are free", where that is certain
Result<void> require_room(const std::string& file, const GridBytes& grid, const BesideGrid& beside,
                          std::uint64_t points);

} // namespace isotet::jobs
