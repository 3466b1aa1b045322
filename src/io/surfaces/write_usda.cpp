// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// USD as text: one Mesh, a GeomSubset for each isovalue and part, fields of one and three components as primvars.
#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "check/triangle_groups.hpp"
#include "io/surfaces/float_positions.hpp"
#include "io/surfaces/surface_colors.hpp"
#include "io/write/write_formats.hpp"
#include "io/write/write_names.hpp"
#include "io/write/write_text.hpp"

namespace isotet::io {
namespace {

using checking::TriangleGroup;
using checking::triangle_groups;

constexpr std::array<std::string_view, 3> mesh_fields{"isovalue", "part", "boundary"};

/// Letters, digits and _ stay; names begin with no digit.
std::string usd_name(std::string_view name) {
    std::string out;
    for (const char c : name) {
        const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
        out += letter || (c >= '0' && c <= '9') ? c : '_';
    }
    if (out.empty() || (out[0] >= '0' && out[0] <= '9')) out.insert(0, "_");
    return out;
}

void append_tuples(std::string& out, const Column& column, std::size_t begin, std::size_t end) {
    const FloatRows rows(column, begin, end);
    std::string row;
    for (std::size_t i = begin; i < end; ++i) {
        row.clear();
        rows.append(row, i);
        if (i > 0) out += ", ";
        if (column.components > 1) out += '(';
        for (const char c : std::string_view(row).substr(1)) {
            if (c == ' ') out += ", ";
            else out += c;
        }
        if (column.components > 1) out += ')';
    }
}

/// "float", "double3" and so on; empty for what is left out.
std::string type_of_primvar(const Column& field) {
    const bool real = field.type == ScalarType::float32 || field.type == ScalarType::float64;
    if (!real || (field.components != 1 && field.components != 3)) return {};
    return fmt::format("{}{}", field.type == ScalarType::float32 ? "float" : "double",
                       field.components == 3 ? "3" : "");
}

class UsdMesh {
public:
    UsdMesh(const SurfaceToWrite& input, WriteStream& stream) : input_(input), stream_(stream) {}

    void write(const std::vector<TriangleGroup>& groups) {
        const SurfaceColumns& columns = input_.columns;
        stream_.text("#usda 1.0\n(\n    defaultPrim = \"surface\"\n    metersPerUnit = 1\n    upAxis = "
                     "\"Z\"\n)\n\ndef Mesh \"surface\"\n{\n    uniform token subdivisionScheme = \"none\"\n");
        tuples("point3f[] points", positions());
        counts();
        corners();
        if (columns.point_normals) tuples("normal3f[] normals", *columns.point_normals, at_vertices);
        for (const Column& field : columns.point_fields) {
            if (is_color(field)) colors(field);
            const std::string type = type_of_primvar(field);
            if (!type.empty())
                tuples(fmt::format("{}[] primvars:{}", type, take_name(usd_name(field.name), names_)), field,
                       at_vertices);
        }
        if (groups.size() > 1) {
            for (const TriangleGroup& group : groups) subset(group);
        }
        stream_.text("}\n");
    }

private:
    static constexpr std::string_view at_vertices = " (\n        interpolation = \"vertex\"\n    )";

    void rows(std::string_view what, std::size_t count, const RowWriter& writer, std::string_view after = {}) {
        stream_.text(fmt::format("    {} = [", what));
        stream_.rows(count, writer);
        stream_.text(fmt::format("]{}\n", after));
    }

    void tuples(std::string_view what, const Column& column, std::string_view after = {}) {
        const auto write = [&](std::size_t begin, std::size_t end, std::string& out) {
            append_tuples(out, column, begin, end);
        };
        rows(what, column.tuples, write, after);
    }

    /// USD has float32 only.
    Column positions() const {
        const FloatPositions places = float_positions(input_, "USD");
        Column column{"", ScalarType::float32, input_.surface.vertex_count(), 3, {}};
        column.fill = [this, places](std::size_t begin, std::size_t end, std::byte* out) {
            auto* row = reinterpret_cast<std::array<float, 3>*>(out);
            for (std::size_t vertex = begin; vertex < end; ++vertex) *row++ = places.at(input_.surface, vertex);
        };
        return column;
    }

    void colors(const Column& field) {
        if (!names_.insert("displayColor").second) return;
        Column light{"", ScalarType::float32, field.tuples, 3, {}};
        light.fill = [&field, table = light_of_bytes()](std::size_t begin, std::size_t end, std::byte* out) {
            std::vector<std::uint8_t> bytes((end - begin) * field.components);
            field.fill(begin, end, reinterpret_cast<std::byte*>(bytes.data()));
            auto* row = reinterpret_cast<std::array<float, 3>*>(out);
            for (std::size_t i = 0; i < end - begin; ++i, ++row)
                for (std::size_t k = 0; k < 3; ++k)
                    (*row)[k] = static_cast<float>(table[bytes[i * field.components + k]]);
        };
        tuples("color3f[] primvars:displayColor", light, at_vertices);
    }

    void counts() {
        rows("int[] faceVertexCounts", input_.surface.triangle_count(),
             [](std::size_t begin, std::size_t end, std::string& out) {
                 for (std::size_t i = begin; i < end; ++i) out += i > 0 ? ", 3" : "3";
             });
    }

    void corners() {
        const auto write = [&](std::size_t begin, std::size_t end, std::string& out) {
            std::string_view comma = begin > 0 ? ", " : "";
            for (const std::int64_t corner : corners_of(input_.surface.triangles, begin, end)) {
                out += comma;
                append_number(out, corner);
                comma = ", ";
            }
        };
        rows("int[] faceVertexIndices", input_.surface.triangle_count(), write);
    }

    void subset(const TriangleGroup& group) {
        stream_.text(fmt::format("\n    def GeomSubset \"{}\"\n    {{\n        uniform token elementType = \"face\"\n"
                                 "        uniform token familyName = \"partition\"\n    ",
                                 take_name(usd_name(group.name), names_)));
        rows("int[] indices", group.triangles.size(), [&](std::size_t begin, std::size_t end, std::string& out) {
            for (std::size_t i = begin; i < end; ++i) {
                if (i > 0) out += ", ";
                append_number(out, group.triangles[i]);
            }
        });
        stream_.text("    }\n");
    }

    const SurfaceToWrite& input_;
    WriteStream& stream_;
    Names names_;
};

} // namespace

Result<WriteReport> write_usda(const SurfaceToWrite& input) {
    const SurfaceColumns& columns = input.columns;
    constexpr std::size_t most = std::numeric_limits<std::int32_t>::max();
    if (columns.positions.tuples > most)
        return Error{ErrorCode::invalid_argument, fmt::format("the surface has {} vertices, but USD holds at most {}",
                                                              columns.positions.tuples, most)};
    std::vector<Column> points, cells = columns.cell_fields;
    std::ranges::copy_if(columns.point_fields, std::back_inserter(points),
                         [](const Column& field) { return type_of_primvar(field).empty() && !is_color(field); });
    std::erase_if(cells, [](const Column& field) {
        return std::ranges::find(mesh_fields, field.name) != mesh_fields.end();
    });
    note_left_out(input, "USD", {&columns.edges, &points, &cells});
    const std::vector<TriangleGroup> groups = triangle_groups(input.surface, mesh_fields);
    return write_file(input.path, input.progress, 5 * columns.bytes(),
                      [&](WriteStream& stream) { UsdMesh(input, stream).write(groups); });
}

} // namespace isotet::io
