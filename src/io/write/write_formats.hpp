// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One function for each format that isotet writes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/write.hpp>

#include "io/write/write_columns.hpp"

namespace isotet::io {

/// What write_surface() hands to the writer of one format.
struct SurfaceToWrite {
    const Surface& surface;
    const SurfaceColumns& columns;
    const std::string& path;
    const Progress& progress;
    std::vector<std::string>& notes; ///< the writer adds what its format could not hold
    Compression compression = Compression::none; ///< only for formats that have it
};

Result<WriteReport> write_vtp(const SurfaceToWrite& input);
Result<WriteReport> write_legacy_surface(const SurfaceToWrite& input);
Result<WriteReport> write_ply(const SurfaceToWrite& input);
Result<WriteReport> write_stl(const SurfaceToWrite& input);
Result<WriteReport> write_obj(const SurfaceToWrite& input);
Result<WriteReport> write_ts(const SurfaceToWrite& input);
Result<WriteReport> write_glb(const SurfaceToWrite& input);
Result<WriteReport> write_3mf(const SurfaceToWrite& input);
Result<WriteReport> write_usda(const SurfaceToWrite& input);

/// Notes what a format has no place for: "OBJ holds no fields: pressure, temperature were left out".
void note_left_out(const SurfaceToWrite& input, std::string_view format,
                   const std::vector<const std::vector<Column>*>& lists);

/// A grid as columns, checked. `grid` must outlive it.
struct GridColumns {
    Column points;
    Column connectivity; ///< int32 where connectivity and offsets fit, else int64
    Column offsets;      ///< same type: where each cell starts, and last where the last one ends
    Column types;        ///< uint8
    std::optional<Column> faces; ///< of polyhedra, as Cells has them; nothing where no cell has faces
    Column face_ends;            ///< int64: where each cell's part of `faces` ends, -1 where it has none
    std::vector<Column> point_fields, cell_fields;
    std::size_t cells = 0;

    std::uint64_t bytes() const;
};

/// Errors   invalid_argument: an array of the wrong length or type, cells that the formats cannot hold;
///          invalid_data: offsets that fall, a cell with a point that is not there
Result<GridColumns> columns_of(const Grid& grid, std::vector<std::string>& notes);

struct GridToWrite {
    const GridColumns& columns;
    const std::string& path;
    const Progress& progress;
    Compression compression = Compression::none; ///< only for formats that have it
};

Result<WriteReport> write_vtu(const GridToWrite& input);
Result<WriteReport> write_legacy_grid(const GridToWrite& input);

} // namespace isotet::io
