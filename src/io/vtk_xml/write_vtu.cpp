// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTK XML UnstructuredGrid (.vtu).
#include <fmt/core.h>

#include "io/vtk_xml/write_vtk_xml.hpp"
#include "io/write/write_formats.hpp"

namespace isotet::io {

Result<WriteReport> write_vtu(const GridToWrite& input) {
    const auto& columns = input.columns;
    // The XML format tells where each cell ends, not where it starts.
    Column ends = columns.offsets;
    ends.tuples = columns.cells;
    ends.fill = [&columns](std::size_t begin, std::size_t end, std::byte* out) {
        columns.offsets.fill(begin + 1, end + 1, out);
    };

    VtkXmlFile file("UnstructuredGrid", input.compression);
    file.line(fmt::format(R"(<Piece NumberOfPoints="{}" NumberOfCells="{}">)", columns.points.tuples, columns.cells));
    file.line("<PointData>");
    for (const auto& column : columns.point_fields) file.array(column);
    file.line("</PointData>\n<CellData>");
    for (const auto& column : columns.cell_fields) file.array(column);
    file.line("</CellData>\n<Points>");
    file.array(columns.points);
    file.line("</Points>\n<Cells>");
    file.flat_array(columns.connectivity);
    file.flat_array(ends);
    file.flat_array(columns.types);
    if (columns.faces) {
        file.flat_array(*columns.faces);
        file.flat_array(columns.face_ends);
    }
    file.line("</Cells>\n</Piece>");
    return write_file(input.path, input.progress, file.bytes(), [&](WriteStream& stream) { file.write(stream); });
}

} // namespace isotet::io
