// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTK's XML formats as readers of isotet::read().
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/pieces/loaded.hpp"
#include "io/reader.hpp"

namespace isotet::io {

/// VTU, VTI, VTR, VTS, those in pieces, VTM, VTPC, VTPD, VTH, VTHB and PVD.
std::vector<GridReader> vtk_xml_readers();

/// A file of the format of this name, with its arrays; nothing where it is none of these.
std::optional<Result<Loaded>> load_vtk_xml(const std::string& format, const std::string& path,
                                           const ReadOptions& options, const Progress& progress);

/// The type that the name of a file of these formats stands for ("UnstructuredGrid" for .vtu); empty for others, and for
/// collections.
std::string_view vtk_type_of_name(std::string_view name);

/// A grid of any of these types but a collection; `ids`: with global numbers to join it with others by.
Result<Loaded> load_vtk_file(const std::string& path, std::string_view type, const ReadOptions& options, Depth depth,
                             bool ids, const Progress& progress);

/// A VTM, VTPC or VTPD: an index of files by block. Blocks that are surfaces are left out, and files that are not there,
/// but of a VTPD.
///
/// Errors   invalid_argument: a block that is not there; file: all files are missing, or one of a block that is asked
///          for; invalid_data: not such an index, blocks in more than 64 others,
///          no block with a grid, a file of another kind; as load_files()
Result<Loaded> load_blocks(const std::string& path, std::string_view type, const ReadOptions& options, Depth depth,
                           const Progress& progress);

/// A VTH or VTHB: an index of images (VTI) by level, as one grid of hexahedra.
///
/// Errors   invalid_data: not such an index, a level without a spacing, a box without a file, an image that is not where
///          its box is; as load_files() and amr::boxes_as_pieces()
Result<Loaded> load_amr(const std::string& path, const ReadOptions& options, Depth depth, const Progress& progress);

/// Names of files by time.
struct TimeIndex {
    std::map<double, std::vector<std::string>> names;
    std::vector<std::string> notes;
};

/// What a PVD names.
Result<TimeIndex> index_of_collection(const std::string& path);

/// The grid of a step of an index by time, whose files are of these formats or legacy VTK; those of one time are pieces of
/// one grid.
Result<Loaded> load_times(const std::string& path, const Result<TimeIndex>& index, const ReadOptions& options,
                          Depth depth, const Progress& progress);

/// The file of a step; nothing where load_times() reads it, or tells why not.
Result<std::optional<FileOfTime>> file_of_time(const std::string& path, const Result<TimeIndex>& index,
                                               const ReadOptions& options);

/// A file series of ParaView (.vtm.series, .vtu.series and so on): JSON that names the files.
GridReader series_reader();

} // namespace isotet::io
