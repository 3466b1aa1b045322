// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTK XML PolyData (.vtp).
#include <fmt/core.h>

#include "io/vtk_xml/write_vtk_xml.hpp"
#include "io/write/write_formats.hpp"

namespace isotet::io {
namespace {

void add_data(VtkXmlFile& file, std::string_view element, const std::optional<Column>& normals,
              const std::vector<const std::vector<Column>*>& lists) {
    file.line(normals ? fmt::format("<{} Normals=\"{}\">", element, normals->name) : fmt::format("<{}>", element));
    if (normals) file.array(*normals);
    for (const auto* list : lists) {
        for (const auto& column : *list) file.array(column);
    }
    file.line(fmt::format("</{}>", element));
}

} // namespace

Result<WriteReport> write_vtp(const SurfaceToWrite& input) {
    const auto& columns = input.columns;
    const std::size_t triangles = columns.triangles.tuples;
    const Column offsets = counting("offsets", columns.triangles.type, triangles, 3, 3);

    VtkXmlFile file("PolyData", input.compression);
    if (!columns.field_data.empty()) {
        file.line("<FieldData>");
        for (const Column& column : columns.field_data) file.array_of_file(column);
        file.line("</FieldData>");
    }
    file.line(fmt::format(
        R"(<Piece NumberOfPoints="{}" NumberOfVerts="0" NumberOfLines="0" NumberOfStrips="0" NumberOfPolys="{}">)",
        columns.positions.tuples, triangles));
    add_data(file, "PointData", columns.point_normals, {&columns.edges, &columns.point_fields});
    add_data(file, "CellData", columns.cell_normals, {&columns.cell_fields});
    file.line("<Points>");
    file.array(columns.positions);
    file.line("</Points>\n<Polys>");
    file.flat_array(columns.triangles);
    file.flat_array(offsets);
    file.line("</Polys>\n</Piece>");
    return write_file(input.path, input.progress, file.bytes(), [&](WriteStream& stream) { file.write(stream); });
}

} // namespace isotet::io
