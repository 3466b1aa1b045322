// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Wavefront OBJ: vertices, normals, faces.
#include <fmt/core.h>

#include "io/write/write_formats.hpp"
#include "io/write/write_text.hpp"

namespace isotet::io {
namespace {

RowWriter float_rows(std::string_view keyword, const Column& column) {
    return [keyword, &column](std::size_t begin, std::size_t end, std::string& out) {
        const FloatRows rows(column, begin, end);
        for (std::size_t i = begin; i < end; ++i) {
            out += keyword;
            rows.append(out, i);
            out += '\n';
        }
    };
}

} // namespace

Result<WriteReport> write_obj(const SurfaceToWrite& input) {
    const auto& columns = input.columns;
    note_left_out(input, "OBJ", {&columns.edges, &columns.point_fields, &columns.cell_fields});
    constexpr std::uint64_t line = 32;
    return write_file(
        input.path, input.progress, (columns.positions.tuples + columns.triangles.tuples) * line,
        [&](WriteStream& stream) {
            stream.text("# isotet\n");
            stream.rows(columns.positions.tuples, float_rows("v", columns.positions));
            if (columns.point_normals)
                stream.rows(columns.point_normals->tuples, float_rows("vn", *columns.point_normals));
            if (columns.cell_normals)
                stream.rows(columns.cell_normals->tuples, float_rows("vn", *columns.cell_normals));
            stream.rows(columns.triangles.tuples, [&](std::size_t begin, std::size_t end, std::string& out) {
                const auto corners = corners_of(input.surface.triangles, begin, end);
                for (std::size_t i = 0; i < corners.size(); ++i) {
                    out += i % 3 == 0 ? "f " : " ";
                    append_number(out, corners[i] + 1);
                    if (columns.point_normals || columns.cell_normals) {
                        out += "//";
                        append_number(out, columns.point_normals ? corners[i] + 1
                                                                 : static_cast<std::int64_t>(begin + i / 3 + 1));
                    }
                    if (i % 3 == 2) out += '\n';
                }
            });
        });
}

} // namespace isotet::io
