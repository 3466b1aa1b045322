// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Gmsh's MSH files, versions 1.0, 2.0 to 2.2, 4.0 and 4.1, ascii and binary in either byte order.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/files/byte_source.hpp"

namespace isotet::io {

/// Tells what an MSH file holds: fields of $NodeData, $ElementData and $ElementNodeData, `gmsh:physical`,
/// `gmsh:geometrical`, `gmsh:partition`, times.
///
/// The times of a file are the different time values of its data sections; where one field has two sections of one time
/// value, the time step numbers take their place. A file whose only time is 0 knows no time.
///
/// `bytes`   the whole file
/// `step`    whose fields are told; nothing: those of all steps
Result<FileInfo> inspect_gmsh(std::string_view bytes, const Progress& progress, std::optional<std::size_t> step = {});

/// An MSH file without the most of its long sections: inspect_gmsh() says of it what it says of the file. Nothing where
/// the whole file is needed for that.
///
/// `searches`   sections whose counts do not tell where they end are gone through: text
/// Cost         with counts by the number of blocks, else a pass over the file; memory for a few MB
/// Errors       as ByteSource; cancelled
Result<std::optional<std::string>> heads_of_gmsh(const ByteSource& source, bool searches, const Progress& progress);

/// Reads an MSH file.
///
/// Elements of all dimensions become cells, in the order of the file; corners come first, the other nodes of
/// higher-order elements in the file's order. Fields are float64, NaN where the file gives no value. A field with one
/// data section belongs to every time step; one that has several but none at the step is left out with a note.
/// `gmsh:physical`, `gmsh:geometrical`: int32 cell fields, the first tags of each element (1.0, 2.x), or the first physical
/// group and the number of its entity (4.x), before partitioning. `gmsh:partition`: the partition that has the element.
/// $ElementNodeData becomes a point field: where elements give one node different values, their mean, with a note.
/// Mesh sections that occur again with the same nodes and elements are passed over. A data section that is broken is left
/// out.
///
/// Errors   invalid_data: a rule of the format broken, with section, value and rule; invalid_argument: no such step
Result<ReadResult> parse_gmsh(std::string_view bytes, const ReadOptions& options, const Progress& progress);

} // namespace isotet::io
