// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTK XML PolyData (.vtp) of every encoding.
#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/scalars.hpp"
#include "io/files/text_scanner.hpp"
#include "io/surfaces/surface_parts.hpp"
#include "io/vtk_xml/columns.hpp"

namespace isotet::io::vtk_xml {
namespace {

/// Makes the surface of one Piece element.
class SurfaceOfPiece {
public:
    SurfaceOfPiece(Document& document, const pugi::xml_node& piece, std::vector<std::string>& notes,
                   const Progress& progress)
        : document_(document), piece_(piece), progress_(progress), notes_(notes) {}

    Result<Surface> read() {
        if (auto points = read_points(); !points) return points.error();
        for (const char* const section : {"Verts", "Lines"}) {
            // They make no triangles, but their cells come first in the cell data.
            const auto offsets = read_offsets(section);
            if (!offsets) return offsets.error();
            parts_.cells.skip_cells(offsets->size());
        }
        if (auto polys = read_cells("Polys"); !polys) return polys.error();
        if (auto strips = read_cells("Strips"); !strips) return strips.error();
        if (auto data = read_data("PointData", parts_.positions.tuples(), parts_.point_data); !data)
            return data.error();
        if (auto data = read_data("CellData", parts_.cells.cells(), parts_.cell_data); !data) return data.error();
        return assemble(std::move(parts_));
    }

private:
    Result<void> read_points() {
        const auto count = count_of(piece_, "NumberOfPoints", 0);
        if (!count) return count.error();
        auto points = load_points(document_, {piece_}, Layout{{*count}, *count, {}}, 0, progress_);
        if (!points) return points.error();
        parts_.positions = std::move(*points);
        return {};
    }

    Result<std::vector<std::uint64_t>> read_indices(const char* section, const char* name, std::uint64_t count) {
        for (const auto& element : piece_.child(section).children()) {
            if (std::string_view(element.attribute("Name").value()) != name) continue;
            const auto array = describe_array(document_, element);
            if (!array) return array.error();
            if (!*array || is_floating((*array)->type) || (*array)->components != 1)
                return invalid_data(fmt::format("{} \"{}\" is not integers with one component", section, name));
            const auto values = load_array(document_, **array, count, progress_);
            if (!values) return values.error();
            return as_indices(*values);
        }
        return invalid_data(fmt::format("{} has no array \"{}\"", section, name));
    }

    /// Where the corners of each cell end; nothing of a section that announces no cells.
    Result<std::vector<std::uint64_t>> read_offsets(const std::string& section) {
        const auto count = count_of(piece_, ("NumberOf" + section).c_str(), 0);
        if (!count) return count.error();
        if (*count == 0) return std::vector<std::uint64_t>();
        return read_indices(section.c_str(), "offsets", *count);
    }

    Result<void> read_cells(const char* section) {
        const auto offsets = read_offsets(section);
        if (!offsets) return offsets.error();
        if (offsets->empty()) return {};
        std::uint64_t begin = 0;
        for (std::size_t i = 0; i < offsets->size(); begin = (*offsets)[i++])
            if ((*offsets)[i] < begin || (*offsets)[i] > document_.source.size() * 0x4000ULL)
                return invalid_data(fmt::format("{} offsets[{}] is {} after {}", section, i,
                                                static_cast<std::int64_t>((*offsets)[i]), begin));
        const auto connectivity = read_indices(section, "connectivity", offsets->back());
        if (!connectivity) return connectivity.error();
        const bool strips = std::string_view(section) == "Strips";
        begin = 0;
        for (const std::uint64_t end : *offsets) {
            const auto corners = std::span(*connectivity).subspan(begin, end - begin);
            if (strips) parts_.cells.add_strip(corners);
            else parts_.cells.add_polygon(corners);
            begin = end;
        }
        return {};
    }

    Result<void> read_data(const char* section, std::uint64_t tuples, std::vector<Attribute>& attributes) {
        const pugi::xml_node element = piece_.child(section);
        const std::string_view normals = element.attribute("Normals").value();
        const Section described = describe_section(document_, element, 0);
        for (const LeftOut& item : described.left_out) note_left_out(item.name, item.reason);
        for (const std::string& name : described.repeated) note_left_out(name, "it is there more than once: the first is read");
        for (const DataArray& array : described.arrays) {
            auto values = load_array(document_, array, tuples, progress_);
            if (!values && values.error().code == ErrorCode::invalid_data) {
                note_left_out(array.name, values.error().message);
                continue;
            }
            if (!values) return values.error();
            attributes.push_back({array.name, std::move(*values), array.name == normals});
        }
        return {};
    }

    void note_left_out(const std::string& name, std::string_view reason) {
        notes_.push_back(fmt::format("the array {} is left out: {}", in_quotes(name), reason));
    }

    Document& document_;
    pugi::xml_node piece_;
    const Progress& progress_;
    std::vector<std::string>& notes_;
    SurfaceParts parts_;
};

/// Of the arrays of the file as a whole those that isotet wrote.
Result<void> read_field_data(Document& document, std::vector<Field>& field_data, std::vector<std::string>& notes,
                             const Progress& progress) {
    for (const auto& element : document.primary().child("FieldData").children("DataArray")) {
        const std::string_view name = element.attribute("Name").value();
        if (!name.starts_with(own_field_data)) continue;
        const auto count = count_of(element, "NumberOfTuples", 0);
        const auto array = describe_array(document, element);
        if (!count || !array || !*array) continue;
        auto values = load_array(document, **array, *count, progress);
        if (values) field_data.push_back({std::string(name), *std::move(values)});
        else if (values.error().code != ErrorCode::invalid_data) return values.error();
        else notes.push_back(fmt::format("the array {} is left out: {}", in_quotes(name), values.error().message));
    }
    return {};
}

} // namespace
} // namespace isotet::io::vtk_xml

namespace isotet::io {

Result<Surface> parse_vtp(std::string_view content, std::vector<std::string>& notes, std::vector<Field>& field_data,
                          const Progress& progress) {
    auto document = vtk_xml::open_document(ByteSource(content), progress);
    if (!document) return document.error();
    if (document->type != "PolyData")
        return invalid_data(
            fmt::format("this is a VTK file of type {}, not a surface (PolyData)", in_quotes(document->type)));
    if (auto read = vtk_xml::read_field_data(*document, field_data, notes, progress); !read) return read.error();
    std::vector<Surface> surfaces;
    for (const auto& piece : document->primary().children("Piece")) {
        auto surface = vtk_xml::SurfaceOfPiece(*document, piece, notes, progress).read();
        if (!surface) return surface;
        surfaces.push_back(std::move(*surface));
    }
    if (surfaces.empty()) return invalid_data("the file has no Piece");
    if (surfaces.size() == 1) return std::move(surfaces.front());
    return join(surfaces, {});
}

} // namespace isotet::io
