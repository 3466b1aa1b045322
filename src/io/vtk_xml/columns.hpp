// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Arrays of points or cells over all Piece elements of a file.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/read.hpp>

#include "io/pieces/loaded.hpp"
#include "io/vtk_xml/stored_array.hpp"

namespace isotet::io::vtk_xml {

/// The Piece elements; the primary element itself where there are none.
std::vector<pugi::xml_node> pieces_of(const Document& document);

/// True for the arrays of a step: an attribute TimeStep lists those that an array is for; without it, it is for all.
bool is_of_step(const pugi::xml_node& element, std::size_t step);

/// The arrays of an element, without those of other steps. An array without a name is called "unnamed"; of two of one
/// name the first counts.
struct Section {
    std::vector<DataArray> arrays;
    std::vector<LeftOut> left_out; ///< arrays that cannot be described; `what` is empty
    std::vector<std::string> unnamed, repeated;
    std::string global_ids; ///< the array that is marked so
    std::string active;     ///< the one that is marked as Scalars, else as Vectors
};

Section describe_section(const Document& document, const pugi::xml_node& element, std::size_t step);

/// Where the tuples of each piece go.
struct Layout {
    std::vector<std::uint64_t> tuples; ///< of each piece
    std::uint64_t total = 0;
    /// Puts a piece's tuples to their places; without it they follow one another.
    std::function<void(std::size_t piece, const std::byte* from, std::byte* to, std::size_t tuple_bytes)> place;
};

/// How many points and cells the pieces have.
struct Layouts {
    Layout points, cells;
};

/// Takes the time that the FieldData in `parent` states, where `loaded` has none yet.
Result<void> read_time(Document& document, const pugi::xml_node& parent, const Progress& progress, Loaded& loaded);

/// Tells the fields of all pieces at a step, those that are left out, and the file's times.
///
/// Errors   invalid_argument: no such step; invalid_data: a ghost array that cannot be read
Result<void> announce_fields(Document& document, const Layouts& layouts, const ReadOptions& options,
                             const Progress& progress, Loaded& loaded);

/// The points that the pieces store, of any type with three components: float32 or float64.
Result<Array> load_points(Document& document, const std::vector<pugi::xml_node>& pieces, const Layout& layout,
                          std::size_t step, const Progress& progress);

/// A grid of so many points along each axis, whose cells are implied.
struct GridSize {
    std::uint64_t x = 0, y = 0, z = 0;
};

/// What of a file becomes a Piece besides points and cells.
struct Wanted {
    const ReadOptions& options;
    std::size_t step = 0;
    bool ids = false;                 ///< global numbers, to join files by
    std::string path = {};            ///< where the file can be opened again; empty: nowhere
    std::optional<GridSize> box = {}; ///< of a structured grid: hidden points take out the cells around them
};

/// Cell fields that stay in the file.
struct LaterFields {
    std::shared_ptr<const Document> document;             ///< that load_fields() takes
    std::vector<std::vector<UnreadField>> of_pieces = {}; ///< gets them
};

/// Reads point data and cell data into `piece`: fields that are wanted, ghost marks, global numbers. All arrays side by
/// side. A field that cannot be read is left out, unless the options name it.
///
/// `later`   gets the cell fields, and `piece` has none; null: they are read
Result<void> load_fields(Document& document, const Layouts& layouts, const Wanted& wanted, const Progress& progress,
                         Loaded& loaded, Piece& piece, LaterFields* later = nullptr);

/// The field by which GEOS marks ghost cells.
inline constexpr std::string_view ghost_rank_name = "ghostRank";

/// Marks the cells that vtkGhostType, vtkGhostLevels or GEOS's ghostRank takes out; empty where there are none.
ISOTET_API void mark_left_out(const Array& marks, std::string_view name, std::vector<std::uint8_t>& left_out);

/// Marks the cells of a box around the points that vtkGhostType hides. VTK hides none of other grids' cells so.
ISOTET_API void mark_around_hidden(const Array& marks, std::string_view name, const GridSize& points,
                                   std::vector<std::uint8_t>& left_out);

/// Marks the cells of a box that have a point marked in `hidden`.
ISOTET_API void leave_out_around(const GridSize& points, std::span<const std::uint8_t> hidden,
                                 std::vector<std::uint8_t>& left_out);

/// True for arrays that describe the grid (ghost marks), which are no fields.
ISOTET_API bool is_ghost_array(std::string_view name);

} // namespace isotet::io::vtk_xml
