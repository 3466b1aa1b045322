// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTU, PVTU, VTI, VTR and VTS, in this process and on all threads.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/read.hpp>

#include "io/own/byte_source.hpp"
#include "io/own/loaded.hpp"
#include "io/own/vtk_xml/columns.hpp"

namespace isotet::io::vtk_xml {

/// The attribute `type` of the element VTKFile in the first bytes of a file; empty if there is none.
std::string_view type_of(std::string_view head);

/// One file: a grid of type UnstructuredGrid, ImageData, RectilinearGrid or StructuredGrid, as one piece.
///
/// `type`     that it must have
/// `ids`      global numbers are read, too, to join files by
/// Errors     invalid_data: not such a file, arrays that are missing or too short, pieces that do not cover a box;
///            what open_document() and StoredArray give; out_of_memory; cancelled
/// Cost       the memory of the arrays that are wanted, and a few MB a thread
Result<Loaded> load(const ByteSource& source, std::string_view type, const ReadOptions& options, Depth depth, bool ids,
                    const Progress& progress);

/// The same of a file, whose path its errors and its piece name.
Result<Loaded> load_file(const std::string& path, std::string_view type, const ReadOptions& options, Depth depth,
                         bool ids, const Progress& progress);

/// An index of VTU files, which are read side by side.
Result<Loaded> load_parallel(const std::string& path, const ReadOptions& options, Depth depth,
                             const Progress& progress);

/// Points and cells of all pieces of an UnstructuredGrid, and its fields.
Result<Piece> load_unstructured(Document& document, const Wanted& wanted, const Progress& progress);

/// Points and hexahedra of the structured kinds, and their fields. A flat grid has no hexahedra and no cell fields.
Result<Piece> load_structured(Document& document, const Wanted& wanted, const Progress& progress,
                              std::vector<std::string>& notes);

/// A grid of so many points along each axis, whose cells are implied.
struct GridSize {
    std::uint64_t x = 0, y = 0, z = 0;
};

/// Points of a box in the order of VTK, x fastest.
///
/// As vtkImageData makes them: matrix (three rows) times the numbers along the axes, counted from `first`, and origin.
struct ImagePoints {
    std::array<std::int64_t, 3> first{};
    std::array<double, 9> matrix{1, 0, 0, 0, 1, 0, 0, 0, 1};
    std::array<double, 3> origin{};
};
Result<Array> points_of(const GridSize& size, const ImagePoints& image);
/// From coordinates along each axis.
Result<Array> points_of(const GridSize& size, const std::array<std::vector<double>, 3>& ticks);

/// The hexahedra of a box, and a note that says so.
ISOTET_API Result<Cells> hexahedra_of(const GridSize& points, std::vector<std::string>& notes);

} // namespace isotet::io::vtk_xml
