// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the parsers of surface formats take and give, and how the parts become a Surface.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

#include "io/surfaces/surface_triangles.hpp"

namespace isotet::io {

/// One array of a file, on points or cells.
struct Attribute {
    std::string name;
    Array values;
    bool normals = false; ///< the file says that these are the normals
};

/// What a file holds before it is a Surface. Cells are the file's polygons, lines and so on.
struct SurfaceParts {
    Array positions;
    TriangleList cells;
    std::vector<Attribute> point_data;
    std::vector<Attribute> cell_data;
};

/// Checks lengths and indices and puts the parts into their places: `edge_ends`, `edge_weights` and `source_cell`, as
/// isotet writes them, too.
///
/// Errors   invalid_data: an array of the wrong length, a vertex that is not there
Result<Surface> assemble(SurfaceParts&& parts);

/// The parsers, one a format. `content` is the whole file; they keep nothing of it. `notes` tell what is left out.
///
/// Errors   invalid_data: what was seen, where, and the rule; cancelled
Result<Surface> parse_ply(std::string_view content, const Progress& progress);
Result<Surface> parse_stl(std::string_view content, const Progress& progress);
Result<Surface> parse_obj(std::string_view content, const Progress& progress);
Result<Surface> parse_ts(std::string_view content, const Progress& progress);
Result<Surface> parse_legacy_vtk(std::string_view content, std::vector<Field>& field_data, const Progress& progress);
Result<Surface> parse_3mf(std::string_view content, std::vector<std::string>& notes, const Progress& progress);
Result<Surface> parse_vtp(std::string_view content, std::vector<std::string>& notes, std::vector<Field>& field_data,
                          const Progress& progress);

/// Names of field data that is kept begin so: that of others is of no use to a surface.
inline constexpr std::string_view own_field_data = "isotet:";

/// "vtp", "ply" and so on by the content, then by the ending; empty if neither tells.
std::string_view recognize_surface(std::string_view content, std::string_view ending);

/// Reads a surface out of memory.
///
/// `ending`       of the file's name, in lower case without the dot; may be empty
/// `format`       "vtp" and so on; empty: by content, then by ending
Result<SurfaceFile> parse_surface(std::string_view content, std::string_view ending, std::string_view format,
                                  const Progress& progress);

} // namespace isotet::io
