// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Legacy VTK polydata (.vtk) as a surface.
#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/text_scanner.hpp"
#include "io/vtk_legacy/legacy_vtk.hpp"

namespace isotet::io {

Result<Surface> parse_legacy_vtk(std::string_view content, std::vector<Field>& field_data, const Progress& progress) {
    std::string kind;
    LegacyWants wants;
    wants.dataset = [&](std::string_view name) { return (kind = name) == "polydata"; };
    wants.field = [](Association, std::string_view) { return true; };
    wants.file_arrays = own_field_data;
    wants.tells_text = false;
    auto file = read_legacy_vtk(ByteSource(content), wants, progress);
    if (!kind.empty() && kind != "polydata")
        return invalid_data(fmt::format("this is a dataset of kind {}, not a surface (POLYDATA)", in_quotes(kind)));
    if (!file) return file.error();
    if (!file->info.left_out.empty()) {
        const LeftOut& item = file->info.left_out.front();
        return invalid_data(fmt::format("{} {} cannot be read: {}", item.what, in_quotes(item.name), item.reason));
    }
    if (!file->has_points) return invalid_data("the file has no POINTS");
    SurfaceParts parts;
    parts.positions = std::move(file->points);
    parts.cells.skip_cells(file->vertices.count + file->lines.count);
    file->polygons.each([&](auto corners) { parts.cells.add_polygon(corners); });
    file->strips.each([&](auto corners) { parts.cells.add_strip(corners); });
    parts.point_data = std::move(file->point_data);
    parts.cell_data = std::move(file->cell_data);
    field_data = std::move(file->field_data);
    return assemble(std::move(parts));
}

} // namespace isotet::io
