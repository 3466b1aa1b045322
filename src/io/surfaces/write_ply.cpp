// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// PLY, binary little endian: every scalar field is a property of the vertices or faces.
#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <span>
#include <utility>

#include <fmt/core.h>

#include "io/surfaces/surface_colors.hpp"
#include "io/write/write_formats.hpp"
#include "io/write/write_names.hpp"

namespace isotet::io {
namespace {

constexpr std::int64_t largest_exact = std::int64_t{1} << 53; // integers up to here are doubles

std::string_view ply_type(ScalarType type) {
    switch (type) {
    case ScalarType::int8: return "char";
    case ScalarType::uint8: return "uchar";
    case ScalarType::int16: return "short";
    case ScalarType::uint16: return "ushort";
    case ScalarType::int32: return "int";
    case ScalarType::uint32: return "uint";
    case ScalarType::float32: return "float";
    default: return "double";
    }
}

/// Calls f(begin, end, scalars) with the column's 64-bit integers, piece by piece.
template <class Integer, class F>
void for_each_piece(const Column& column, const F& f) {
    constexpr std::size_t piece = 65536;
    std::vector<Integer> values(std::min(piece, column.tuples) * column.components);
    for (std::size_t begin = 0; begin < column.tuples; begin += piece) {
        const std::size_t end = std::min(column.tuples, begin + piece);
        column.fill(begin, end, reinterpret_cast<std::byte*>(values.data()));
        f(std::span<const Integer>(values).first((end - begin) * column.components));
    }
}

template <class From, class To>
Column cast_column(const Column& column) {
    Column result = column;
    result.type = scalar_type_of<To>();
    result.fill = [source = column](std::size_t begin, std::size_t end, std::byte* out) {
        std::vector<From> values((end - begin) * source.components);
        source.fill(begin, end, reinterpret_cast<std::byte*>(values.data()));
        for (std::size_t i = 0; i < values.size(); ++i) reinterpret_cast<To*>(out)[i] = static_cast<To>(values[i]);
    };
    return result;
}

/// PLY knows no 64-bit integers: they become int where all fit, else double.
template <class Integer>
Column narrowed(const Column& column, std::vector<std::string>& notes) {
    bool fits = true, exact = true;
    for_each_piece<Integer>(column, [&](std::span<const Integer> values) {
        for (const Integer value : values) {
            fits = fits && std::in_range<std::int32_t>(value);
            exact = exact && std::cmp_less_equal(value, largest_exact) && std::cmp_greater_equal(value, -largest_exact);
        }
    });
    if (fits) return cast_column<Integer, std::int32_t>(column);
    if (!exact) {
        notes.push_back(fmt::format("PLY has no 64-bit integers: \"{}\" is written as double and beyond 2^53 not exact",
                                    printable_name(column.name)));
    }
    return cast_column<Integer, double>(column);
}

/// The columns of one element, and the lines that declare their components as properties.
struct Element {
    std::string header;
    std::vector<Column> columns;
    Names names;

    void add(const Column& column, const std::vector<std::string>& properties) {
        for (const auto& property : properties) {
            names.insert(property);
            header += fmt::format("property {} {}\n", ply_type(column.type), property);
        }
        columns.push_back(column);
    }

    void add_field(const Column& field, std::vector<std::string>& notes) {
        Column column = field;
        if (field.type == ScalarType::int64) column = narrowed<std::int64_t>(field, notes);
        if (field.type == ScalarType::uint64) column = narrowed<std::uint64_t>(field, notes);
        if (is_color(field) && !names.contains("red")) {
            add(column, field.components == 3 ? std::vector<std::string>{"red", "green", "blue"}
                                              : std::vector<std::string>{"red", "green", "blue", "alpha"});
            return;
        }
        std::vector<std::string> properties;
        bool renamed = false;
        for (std::size_t i = 0; i < field.components; ++i) {
            const auto wanted = field.components == 1 ? field.name : fmt::format("{}_{}", field.name, i);
            properties.push_back(take_name(ply_name(wanted), names));
            renamed = renamed || properties.back() != wanted;
        }
        if (renamed) {
            notes.push_back(fmt::format("the field \"{}\" is the PLY property {}", printable_name(field.name),
                                        properties.size() == 1 ? properties[0] : properties[0] + " and following"));
        }
        add(column, properties);
    }

    std::size_t row_bytes() const {
        std::size_t sum = 0;
        for (const auto& column : columns) sum += column.tuple_bytes();
        return sum;
    }
};

/// Puts rows [begin, end) of the columns side by side, a row every `stride` bytes, little endian.
void interleave(const std::vector<Column>& columns, std::size_t begin, std::size_t end, char* out, std::size_t stride) {
    std::vector<std::byte> buffer;
    for (const auto& column : columns) {
        const std::size_t tuple = column.tuple_bytes();
        buffer.resize((end - begin) * tuple);
        column.fill(begin, end, buffer.data());
        if (std::endian::native != std::endian::little) {
            swap_bytes(buffer.data(), (end - begin) * column.components, size_of(column.type));
        }
        for (std::size_t i = 0; i < end - begin; ++i) std::memcpy(out + i * stride, buffer.data() + i * tuple, tuple);
        out += tuple;
    }
}

} // namespace

Result<WriteReport> write_ply(const SurfaceToWrite& input) {
    const auto& columns = input.columns;
    const std::size_t vertices = columns.positions.tuples, triangles = columns.triangles.tuples;
    if (vertices > std::numeric_limits<std::uint32_t>::max()) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("the surface has {} vertices, but PLY holds at most 4294967295", vertices)};
    }
    Element vertex, face;
    vertex.add(columns.positions, {"x", "y", "z"});
    if (columns.point_normals) vertex.add(*columns.point_normals, {"nx", "ny", "nz"});
    for (const auto& field : columns.point_fields) vertex.add_field(field, input.notes);

    // int where it is enough: some readers know no other.
    const bool narrow = fits_int32(vertices);
    face.header = fmt::format("property list uchar {} vertex_indices\n", narrow ? "int" : "uint");
    face.names.insert("vertex_indices");
    Column corners = narrow ? converted<std::int32_t>("", input.surface.triangles)
                            : converted<std::uint32_t>("", input.surface.triangles);
    corners.components = 3; // an array of no triangles may not say so
    if (columns.cell_normals) face.add(*columns.cell_normals, {"nx", "ny", "nz"});
    for (const auto& field : columns.cell_fields) face.add_field(field, input.notes);
    note_left_out(input, "PLY", {&columns.edges});

    const std::size_t vertex_bytes = vertex.row_bytes(), face_bytes = 1 + 3 * sizeof(std::uint32_t) + face.row_bytes();
    const std::uint64_t expected = vertices * std::uint64_t{vertex_bytes} + triangles * std::uint64_t{face_bytes};
    std::vector<Column> face_columns{corners};
    face_columns.insert(face_columns.end(), face.columns.begin(), face.columns.end());

    return write_file(input.path, input.progress, expected, [&](WriteStream& stream) {
        stream.text(fmt::format("ply\nformat binary_little_endian 1.0\ncomment isotet\nelement vertex {}\n{}element "
                                "face {}\n{}end_header\n",
                                vertices, vertex.header, triangles, face.header));
        stream.rows(vertices, [&](std::size_t begin, std::size_t end, std::string& out) {
            out.resize((end - begin) * vertex_bytes);
            interleave(vertex.columns, begin, end, out.data(), vertex_bytes);
        });
        stream.rows(triangles, [&](std::size_t begin, std::size_t end, std::string& out) {
            out.assign((end - begin) * face_bytes, '\3'); // the first byte of a face is its number of corners
            interleave(face_columns, begin, end, out.data() + 1, face_bytes);
        });
    });
}

} // namespace isotet::io
