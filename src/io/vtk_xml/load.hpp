// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTU, VTI, VTR and VTS, alone and in pieces, in this process and on all threads.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/read.hpp>

#include "io/files/byte_source.hpp"
#include "io/pieces/loaded.hpp"
#include "io/vtk_xml/columns.hpp"

namespace isotet::io::vtk_xml {

/// The attribute `type` of the element VTKFile in the first bytes of a file; empty if there is none.
std::string_view type_of(std::string_view head);

/// One file: a grid of type UnstructuredGrid, as its pieces; or ImageData, RectilinearGrid or StructuredGrid, as one piece.
///
/// `type`     that it must have
/// `ids`      global numbers are read, too, to join files by
/// `path`     where the file can be opened again, for cells that are read later; empty: all are read now
/// Errors     invalid_data: not such a file, arrays that are missing or too short, pieces that do not cover a box;
///            what open_document() and StoredArray give; out_of_memory; cancelled
/// Cost       the memory of the arrays that are wanted, and a few MB a thread
Result<Loaded> load(const ByteSource& source, std::string_view type, const ReadOptions& options, Depth depth, bool ids,
                    const Progress& progress, const std::string& path = {});

/// The same of a file, whose path its errors and its piece name.
Result<Loaded> load_file(const std::string& path, std::string_view type, const ReadOptions& options, Depth depth,
                         bool ids, const Progress& progress);

/// One of several files that make one grid.
struct File {
    std::string path;
    std::string_view type;
    Depth depth = Depth::arrays;
};

/// Reads files side by side, with global numbers to join them by.
Result<std::vector<Loaded>> load_files(std::span<const File> files, const ReadOptions& options,
                                       const Progress& progress);

/// All pieces, one after another. That structured grids became hexahedra is told once.
Loaded put_together(std::vector<Loaded> parts);

/// The type of the pieces of an index: "ImageData" for "PImageData".
inline std::string_view type_of_pieces(std::string_view type) { return type.substr(1); }

/// The files that an index of type PUnstructuredGrid, PImageData and so on names.
///
/// Errors   invalid_data: it is of another type, or names none; as named_file()
Result<std::vector<std::string>> files_of_pieces(const std::string& path, std::string_view type, bool allow_outside,
                                                 const Progress& progress);

/// The grid of such an index.
Result<Loaded> load_pieces(const std::string& path, std::string_view type, const ReadOptions& options, Depth depth,
                           const Progress& progress);

/// The pieces of an UnstructuredGrid with their points, cells and fields; of several with global numbers. Cells of
/// pieces to be joined may be unread where active ones do (ReadOptions::active_cells).
Result<std::vector<Piece>> load_unstructured(const std::shared_ptr<Document>& document, const Layouts& layouts,
                                             const Wanted& wanted, const Progress& progress, Loaded& loaded);

/// How many points and cells the pieces announce.
Result<Layouts> layouts_of_unstructured(const Document& document);
Result<Layouts> layouts_of_structured(const Document& document);

/// What arrays of a step hold for certain.
LeastCounts least_of_unstructured(const Document& document, const Layouts& layouts, std::size_t step);

/// How many cells a structured kind stands for.
Result<std::uint64_t> count_structured(const Document& document);

/// Points and cells of the structured kinds, and their fields. A line of points has no cells and no cell fields.
Result<Piece> load_structured(Document& document, const Wanted& wanted, const Progress& progress, Loaded& loaded);

/// Leaves out cells of structured pieces that an earlier one has, too: their boxes may overlap, with or without marks of
/// ghost cells.
///
/// Errors   invalid_data when the pieces lie far apart; out_of_memory
/// Cost     one byte and one pass for each cell of the box around them
Result<void> leave_out_overlaps(std::span<Loaded> parts);

/// Points of a box in the order of VTK, x fastest.
///
/// As vtkImageData makes them: matrix (three rows) times the numbers along the axes, counted from `first`, and origin.
struct ImagePoints {
    std::array<std::int64_t, 3> first{};
    std::array<double, 9> matrix{1, 0, 0, 0, 1, 0, 0, 0, 1};
    std::array<double, 3> origin{};
};
ISOTET_API Result<Array> points_of(const GridSize& size, const ImagePoints& image);
/// From coordinates along each axis.
ISOTET_API Result<Array> points_of(const GridSize& size, const std::array<std::vector<double>, 3>& ticks);

/// What a grid is whose cells have no volume: "a plane of 3 x 4 points"; empty where they have one.
std::string flatness(const GridSize& points);

/// How many cells cells_of_box() gives.
ISOTET_API std::uint64_t cells_in_box(const GridSize& points);

/// The hexahedra of a box or the quadrilaterals of a plane, and a note that says so. A line has none.
ISOTET_API Result<Cells> cells_of_box(const GridSize& points, std::vector<std::string>& notes);

} // namespace isotet::io::vtk_xml
