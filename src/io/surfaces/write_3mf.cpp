// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// 3MF, core specification 1.3: an object for each isovalue, one unit of the grid a millimetre.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "base/until_cancelled.hpp"
#include "check/triangle_groups.hpp"
#include "io/files/zip.hpp"
#include "io/write/write_formats.hpp"
#include "io/write/write_names.hpp"
#include "io/write/write_text.hpp"
#include "numbers/point_hash.hpp"

namespace isotet::io {
namespace {

using checking::triangle_groups;
using checking::TriangleGroup;

constexpr std::array<std::string_view, 1> object_fields{"isovalue"};
constexpr std::size_t items_at_once = 1 << 12;                      ///< between two looks for a cancel
constexpr std::uint64_t text_of_vertex = 70, text_of_triangle = 50; // at most, about

constexpr std::string_view content_types =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
)";
constexpr std::string_view relationships =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
)";

/// Whether triangles use every edge as often in one direction as in the other: a sum of hashes, with a sign each, is 0.
bool closes(const Array& triangles, std::span<const std::uint64_t> some, const Progress& progress) {
    std::atomic<std::uint64_t> sum = 0;
    triangles.visit([&](auto corners) {
        core::parallel_pieces(some.size(), items_at_once, progress, [&](std::size_t begin, std::size_t end) {
            std::uint64_t part = 0;
            for (const std::uint64_t triangle : some.subspan(begin, end - begin))
                for (std::size_t k = 0; k < 3; ++k) {
                    const auto from = static_cast<std::uint64_t>(corners[3 * triangle + k]);
                    const auto to = static_cast<std::uint64_t>(corners[3 * triangle + (k + 1) % 3]);
                    const std::uint64_t edge = core::mixed(core::mixed(std::min(from, to)) + std::max(from, to));
                    part += from < to ? edge : -edge;
                }
            sum += part;
        });
    });
    return sum == 0;
}

/// The vertices of some triangles, ascending, each once.
std::vector<std::uint64_t> vertices_of(const Array& triangles, std::span<const std::uint64_t> some,
                                       const Progress& progress) {
    std::vector<std::uint64_t> vertices(3 * some.size());
    triangles.visit([&](auto corners) {
        core::each_until_cancelled(some.size(), items_at_once, progress, [&](std::size_t i) {
            for (std::size_t k = 0; k < 3; ++k)
                vertices[3 * i + k] = static_cast<std::uint64_t>(corners[3 * some[i] + k]);
        });
    });
    core::sort_until_cancelled(progress, vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

template <class Number>
void append_attribute(std::string& out, std::string_view name, Number value) {
    out += ' ';
    out += name;
    out += "=\"";
    append_number(out, value);
    out += '"';
}

void append_vertex(std::string& out, const Array& positions, std::uint64_t vertex) {
    constexpr std::array<std::string_view, 3> axes{"x", "y", "z"};
    out += "<vertex";
    positions.visit([&](auto values) {
        for (std::size_t axis = 0; axis < 3; ++axis) append_attribute(out, axes[axis], values[3 * vertex + axis]);
    });
    out += "/>\n";
}

/// The last part of it is missing where that is cancelled.
void append_object(std::string& out, const Surface& surface, const TriangleGroup& group, std::size_t id,
                   const Progress& progress) {
    std::size_t lines = 0;
    const auto stops = [&] { return ++lines % items_at_once == 0 && progress.cancelled(); };
    constexpr std::array<std::string_view, 3> corners_of_triangle{"v1", "v2", "v3"};
    const std::vector<std::uint64_t> vertices = vertices_of(surface.triangles, group.triangles, progress);
    out +=
        fmt::format("<object id=\"{}\" type=\"{}\" name=\"{}\"><mesh><vertices>\n", id,
                    closes(surface.triangles, group.triangles, progress) ? "model" : "surface", xml_name(group.name));
    for (const std::uint64_t vertex : vertices) {
        if (stops()) return;
        append_vertex(out, surface.positions, vertex);
    }
    out += "</vertices><triangles>\n";
    surface.triangles.visit([&](auto corners) {
        for (const std::uint64_t triangle : group.triangles) {
            if (stops()) return;
            out += "<triangle";
            for (std::size_t k = 0; k < 3; ++k) {
                const auto vertex = static_cast<std::uint64_t>(corners[3 * triangle + k]);
                const auto place = std::lower_bound(vertices.begin(), vertices.end(), vertex) - vertices.begin();
                append_attribute(out, corners_of_triangle[k], place);
            }
            out += "/>\n";
        }
    });
    out += "</triangles></mesh></object>\n";
}

bool has_infinite_positions(const Surface& surface) {
    return surface.positions.visit([](auto values) {
        return std::any_of(values.begin(), values.end(), [](auto x) { return !std::isfinite(static_cast<double>(x)); });
    });
}

std::string model_of(const Surface& surface, const std::vector<TriangleGroup>& groups, const Progress& progress) {
    std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" "
                      "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n<resources>\n";
    std::string items;
    for (std::size_t i = 0; i < groups.size(); ++i) {
        append_object(out, surface, groups[i], i + 1, progress);
        items += fmt::format("<item objectid=\"{}\"/>", i + 1);
    }
    out += "</resources>\n<build>" + items + "</build>\n</model>\n";
    return out;
}

} // namespace

Result<WriteReport> write_3mf(const SurfaceToWrite& input) {
    const Surface& surface = input.surface;
    if (has_infinite_positions(surface))
        return Error{ErrorCode::invalid_data, "a vertex has a coordinate that is not finite: 3MF has no place for it"};
    const std::uint64_t text = text_of_vertex * surface.vertex_count() + text_of_triangle * surface.triangle_count();
    if (auto enough = core::require_memory("writing 3MF", 2 * text + 64 * surface.triangle_count()); !enough)
        return enough.error();
    std::vector<Column> cell_fields = input.columns.cell_fields;
    std::erase_if(cell_fields, [](const Column& field) { return field.name == object_fields[0]; });
    note_left_out(input, "3MF", {&input.columns.edges, &input.columns.point_fields, &cell_fields});
    input.notes.push_back("3MF has units: one unit of the grid is taken for a millimetre");

    ZipWriter archive;
    if (auto ok = archive.add("[Content_Types].xml", content_types); !ok) return ok.error();
    if (auto ok = archive.add("_rels/.rels", relationships); !ok) return ok.error();
    const std::string model =
        model_of(surface, triangle_groups(surface, object_fields, input.progress), input.progress);
    if (input.progress.cancelled()) return Error{ErrorCode::cancelled, "writing was cancelled"};
    if (auto ok = archive.add("3D/3dmodel.model", model, input.progress); !ok) return ok.error();
    const std::string bytes = std::move(archive).finish();
    return write_file(input.path, input.progress, bytes.size(), [&](WriteStream& stream) { stream.text(bytes); });
}

} // namespace isotet::io
