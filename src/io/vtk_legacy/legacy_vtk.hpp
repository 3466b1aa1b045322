// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Legacy VTK files (.vtk), ascii and binary, versions 1.0 to 5.1, of any data set: what surfaces and grids are made of.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/read.hpp>

#include "io/files/byte_source.hpp"
#include "io/pieces/tensor_order.hpp"
#include "io/surfaces/surface_parts.hpp"
#include "io/vtk_legacy/legacy_values.hpp"

namespace isotet::io {

/// Corners that were left in a binary file, of cells that all have as many.
struct CornersInFile {
    std::size_t position = 0;             ///< of the scanner before them
    LegacyType type = legacy_integers;    ///< of 4 bytes, or of 8 with a sign
    std::uint64_t count = 0, corners = 0; ///< numbers there; corners of each cell
    bool interleaved = false;             ///< before the corners of each cell stands how many there are
};

/// Values of a field that were left in a binary file.
struct ValuesInFile {
    std::size_t position = 0, begin = 0; ///< of the scanner before them; of the first one
    LegacyType type = legacy_floats;
    std::uint64_t tuples = 0, components = 1;
    std::optional<TensorOrder> order = {}; ///< of the components, where it is another one than VTK's

    /// In which they are read.
    ScalarType read_type() const { return type.widened ? ScalarType::int64 : type.type; }
};

/// A list of cells (CELLS, POLYGONS and so on).
struct LegacyCells {
    Array connectivity;        ///< corners of all cells one after another; int32, or as the file has them
    Array offsets;             ///< where the corners of each cell begin, and those of the last one end; or empty:
    std::uint64_t corners = 0; ///< so many of each cell
    std::uint64_t count = 0;
    std::uint64_t announced = 0;               ///< corners of all, also where they are skipped
    bool interleaved = false;                  ///< as before version 5.1
    std::optional<CornersInFile> in_file = {}; ///< instead of `connectivity`, as LegacyWants::leave_corners allows

    /// Calls visit(corners) for each cell; offsets have been checked.
    void each(const std::function<void(std::span<const std::uint64_t>)>& visit) const;
};

struct LegacyFile {
    std::string dataset; ///< "polydata", "unstructured_grid" and so on
    bool has_points = false;
    bool has_cells = false;        ///< CELLS or CELL_TYPES, of 0 perhaps
    std::uint64_t point_count = 0; ///< that POINTS announces
    Array points;                  ///< float32 or float64
    LegacyCells vertices, lines, polygons, strips, cells;
    Array cell_types;                     ///< uint8; empty where all are one_type
    std::optional<std::uint8_t> one_type; ///< of all cells
    std::uint64_t cell_type_count = 0;
    std::array<std::uint64_t, 3> dimensions{};
    std::array<std::int64_t, 3> first_index{};    ///< of EXTENT: the origin has the index 0
    std::string_view size_keyword = "DIMENSIONS"; ///< or EXTENT, whose points `dimensions` counts
    std::array<double, 3> origin{0, 0, 0}, spacing{1, 1, 1};
    std::array<Array, 3> coordinates; ///< of a rectilinear grid
    std::vector<Attribute> point_data, cell_data;
    std::map<std::string, ValuesInFile> cell_values_in_file; ///< of those of `cell_data` that LegacyWants::leave says
    std::vector<Field> field_data;                           ///< of the whole file
    FileInfo info; ///< of fields that were not asked for, too; with what is left out
    std::vector<std::string> notes;

    /// What the file announces; too large to be true: the highest number.
    std::uint64_t points_announced() const;
    std::uint64_t cells_announced() const;
};

/// What is wanted of a file.
struct LegacyWants {
    std::function<bool(std::string_view dataset)> dataset; ///< others are an error, before anything is read
    std::function<bool(Association association, std::string_view name)> field;
    bool geometry = true;                                  ///< points and cells
    bool leave_corners = false;                            ///< corners of CELLS may stay in the file
    std::function<bool(std::string_view name)> leave = {}; ///< then: cell fields that may, too; empty: none
    std::string_view file_arrays = {}; ///< of arrays of the whole file those whose names begin so; empty: none
    bool tells_text = true;            ///< arrays of text are told among what is left out
};

/// Reads a whole file. Arrays that are not wanted are skipped; integers of type vtkIdType become int64, as in VTK.
/// An array of data that cannot be read, has another length than the grid or no name is left out, and the rest read on.
///
/// Errors   invalid_data: what was seen, where, and the rule; points or cells that are longer than the rest of the file,
///          before memory is taken; as ByteSource::read(); cancelled
Result<LegacyFile> read_legacy_vtk(const ByteSource& source, const LegacyWants& wants, const Progress& progress);

} // namespace isotet::io
