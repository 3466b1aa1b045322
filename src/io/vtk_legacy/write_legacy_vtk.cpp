// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Legacy VTK (.vtk), binary, version 5.1: the one that VTK 9 reads without turning the cells around.
#include <cstdint>
#include <vector>

#include <fmt/core.h>

#include "io/files/scalars.hpp"
#include "io/write/write_formats.hpp"
#include "io/write/write_names.hpp"

namespace isotet::io {
namespace {

std::string_view legacy_type(ScalarType type) {
    switch (type) {
    case ScalarType::int8: return "char"; // signed where VTK runs on x86; it has no name that is signed everywhere
    case ScalarType::uint8: return "unsigned_char";
    case ScalarType::int16: return "short";
    case ScalarType::uint16: return "unsigned_short";
    case ScalarType::int32: return "int";
    case ScalarType::uint32: return "unsigned_int";
    case ScalarType::int64: return "vtktypeint64";
    case ScalarType::uint64: return "vtktypeuint64";
    case ScalarType::float32: return "float";
    case ScalarType::float64: break;
    }
    return "double";
}

void write_block(WriteStream& stream, const Column& column) {
    stream.column(column, std::endian::big);
    stream.text("\n");
}

void write_arrays(WriteStream& stream, const std::vector<Column>& columns) {
    for (const Column& column : columns) {
        stream.text(fmt::format("{} {} {} {}\n", legacy_vtk_name(column.name), column.components, column.tuples,
                                legacy_type(column.type)));
        write_block(stream, column);
    }
}

void write_header(WriteStream& stream, std::string_view dataset, const std::vector<Column>& field_data,
                  const Column& points) {
    stream.text(fmt::format("# vtk DataFile Version 5.1\nisotet\nBINARY\nDATASET {}\n", dataset));
    if (!field_data.empty()) stream.text(fmt::format("FIELD FieldData {}\n", field_data.size()));
    write_arrays(stream, field_data);
    stream.text(fmt::format("POINTS {} {}\n", points.tuples, legacy_type(points.type)));
    write_block(stream, points);
}

/// As int64, as VTK writes numbers of cells: meshio reads "int" as 64 bits, too.
Column widened(const Column& narrow) {
    Column wide = narrow;
    if (size_of(narrow.type) == sizeof(std::int64_t)) return wide;
    wide.type = ScalarType::int64;
    wide.fill = [narrow](std::size_t begin, std::size_t end, std::byte* out) {
        const std::size_t count = (end - begin) * narrow.components;
        std::vector<std::byte> bytes(count * size_of(narrow.type));
        narrow.fill(begin, end, bytes.data());
        with_type(narrow.type, [&]<class Number>(Number) {
            const auto* const from = reinterpret_cast<const Number*>(bytes.data());
            for (std::size_t i = 0; i < count; ++i)
                reinterpret_cast<std::int64_t*>(out)[i] = static_cast<std::int64_t>(from[i]);
        });
    };
    return wide;
}

/// `offsets` has one entry more than there are cells.
void write_cells(WriteStream& stream, std::string_view keyword, const Column& narrow_offsets, const Column& corners) {
    const Column offsets = widened(narrow_offsets), connectivity = widened(corners);
    stream.text(fmt::format("{} {} {}\nOFFSETS {}\n", keyword, offsets.tuples,
                            connectivity.tuples * connectivity.components, legacy_type(offsets.type)));
    write_block(stream, offsets);
    stream.text(fmt::format("CONNECTIVITY {}\n", legacy_type(connectivity.type)));
    write_block(stream, connectivity);
}

void write_data(WriteStream& stream, std::string_view keyword, std::size_t tuples, const std::optional<Column>& normals,
                const std::vector<const std::vector<Column>*>& lists) {
    std::size_t count = 0;
    for (const auto* list : lists) count += list->size();
    // Without tuples there are no bytes, and VTK stops at an array of none.
    if (tuples == 0 || (count == 0 && !normals)) return;
    stream.text(fmt::format("{} {}\n", keyword, tuples));
    if (normals) {
        stream.text(fmt::format("NORMALS {} {}\n", legacy_vtk_name(normals->name), legacy_type(normals->type)));
        write_block(stream, *normals);
    }
    if (count == 0) return;
    stream.text(fmt::format("FIELD FieldData {}\n", count));
    for (const auto* list : lists) write_arrays(stream, *list);
}

} // namespace

Result<WriteReport> write_legacy_surface(const SurfaceToWrite& input) {
    const auto& columns = input.columns;
    const std::size_t triangles = columns.triangles.tuples;
    return write_file(input.path, input.progress, columns.bytes(), [&](WriteStream& stream) {
        write_header(stream, "POLYDATA", columns.field_data, columns.positions);
        if (triangles) {
            write_cells(stream, "POLYGONS", counting("offsets", columns.triangles.type, triangles + 1, 0, 3),
                        columns.triangles);
        }
        write_data(stream, "CELL_DATA", triangles, columns.cell_normals, {&columns.cell_fields});
        write_data(stream, "POINT_DATA", columns.positions.tuples, columns.point_normals,
                   {&columns.edges, &columns.point_fields});
    });
}

Result<WriteReport> write_legacy_grid(const GridToWrite& input) {
    const auto& columns = input.columns;
    if (columns.faces)
        return Error{ErrorCode::invalid_argument, "the grid has polyhedra, which are written into .vtu only"};
    return write_file(input.path, input.progress, columns.bytes(), [&](WriteStream& stream) {
        write_header(stream, "UNSTRUCTURED_GRID", {}, columns.points);
        if (columns.cells) {
            write_cells(stream, "CELLS", columns.offsets, columns.connectivity);
            stream.text(fmt::format("CELL_TYPES {}\n", columns.cells));
            Column types{"types", ScalarType::int32, columns.cells, 1, {}};
            types.fill = [&](std::size_t begin, std::size_t end, std::byte* out) {
                // Into the second half of the room, then widened from the front: no entry is overwritten unread.
                std::byte* const narrow = out + (end - begin) * 3;
                columns.types.fill(begin, end, narrow);
                auto* wide = reinterpret_cast<std::int32_t*>(out);
                for (std::size_t i = 0; i < end - begin; ++i) wide[i] = std::to_integer<std::int32_t>(narrow[i]);
            };
            write_block(stream, types);
        }
        write_data(stream, "CELL_DATA", columns.cells, std::nullopt, {&columns.cell_fields});
        write_data(stream, "POINT_DATA", columns.points.tuples, std::nullopt, {&columns.point_fields});
    });
}

} // namespace isotet::io
