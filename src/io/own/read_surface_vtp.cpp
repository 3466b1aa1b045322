// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTK XML PolyData (.vtp): ascii, base64 and raw appended data, not compressed.
#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include <fmt/core.h>

#include "core/errors.hpp"
#include "io/own/pace.hpp"
#include "io/own/surface_parts.hpp"
#include "io/own/surface_scalars.hpp"
#include "io/own/surface_xml_arrays.hpp"

namespace isotet::io {
namespace {

enum class Section : std::uint8_t { none, point_data, cell_data, points, verts, lines, strips, polys };
constexpr std::array<std::string_view, 8> section_names{"",      "PointData", "CellData", "Points",
                                                        "Verts", "Lines",     "Strips",   "Polys"};
constexpr std::array<std::string_view, 8> count_names{
    "", "", "", "NumberOfPoints", "NumberOfVerts", "NumberOfLines", "NumberOfStrips", "NumberOfPolys"};

/// A Piece element: its counts and arrays, by section.
struct Piece {
    std::array<std::uint64_t, 8> counts{};
    std::array<std::vector<XmlArray>, 8> arrays;
    std::array<std::string, 8> normals; ///< the array that a section's attribute Normals names

    const std::vector<XmlArray>& of(Section section) const { return arrays[static_cast<std::size_t>(section)]; }
    std::uint64_t count(Section section) const { return counts[static_cast<std::size_t>(section)]; }
};

struct Header {
    std::vector<Piece> pieces;
    XmlEncoding encoding;
    std::string compressor;
};

/// Walks the elements down to the arrays, or to where the appended data starts.
class HeaderReader {
public:
    explicit HeaderReader(std::string_view content) : content_(content), scanner_(content) {}

    Result<Header> read() {
        for (;;) {
            auto tag = scanner_.next();
            if (!tag) return tag.error();
            if (tag->name.empty()) return invalid_data("the file ends before </VTKFile>");
            if (tag->name == "VTKFile" && tag->end) return std::move(header_);
            if (tag->name == "AppendedData") {
                if (auto found = find_appended(*tag); !found) return found.error();
                return std::move(header_);
            }
            if (auto taken = take(*tag); !taken) return taken.error();
        }
    }

private:
    Result<void> take(const XmlTag& tag) {
        if (tag.name == "VTKFile") return take_file(tag);
        if (!is_polydata_)
            return invalid_data(fmt::format("the first element is {}, not VTKFile", in_quotes(tag.name)));
        if (tag.name == "Piece" && !tag.end) return take_piece(tag);
        if (tag.name == "DataArray" && !tag.end) return take_array(tag);
        const auto section = std::ranges::find(section_names, tag.name);
        if (section == section_names.end() || header_.pieces.empty())
            return {}; // FieldData and others: nothing of ours
        const auto index = static_cast<std::size_t>(section - section_names.begin());
        section_ = tag.end || tag.closed ? Section::none : static_cast<Section>(index);
        if (!tag.end) header_.pieces.back().normals[index] = tag.get("Normals");
        return {};
    }

    Result<void> take_file(const XmlTag& tag) {
        const auto type = tag.get("type");
        if (type != "PolyData")
            return invalid_data(
                fmt::format("this is a VTK file of type {}, not a surface (PolyData)", in_quotes(type)));
        is_polydata_ = true;
        header_.compressor = tag.get("compressor");
        const auto order = tag.get("byte_order", "LittleEndian"), size = tag.get("header_type", "UInt32");
        if (order != "LittleEndian" && order != "BigEndian")
            return invalid_data(fmt::format("the byte order {} is not known", in_quotes(order)));
        if (size != "UInt32" && size != "UInt64")
            return invalid_data(fmt::format("the header type {} is not UInt32 or UInt64", in_quotes(size)));
        header_.encoding.order = order == "BigEndian" ? std::endian::big : std::endian::little;
        header_.encoding.wide_header = size == "UInt64";
        return {};
    }

    Result<void> take_piece(const XmlTag& tag) {
        auto& piece = header_.pieces.emplace_back();
        for (std::size_t i = 0; i < count_names.size(); ++i) {
            if (count_names[i].empty()) continue;
            const auto count = tag.get(count_names[i], "0");
            if (!parse_number(count, piece.counts[i]))
                return invalid_data(fmt::format("{} is {}, not a count", count_names[i], in_quotes(count)));
        }
        return {};
    }

    Result<void> take_array(const XmlTag& tag) {
        if (section_ == Section::none || header_.pieces.empty()) return {};
        auto array = describe_array(tag, tag.closed ? std::string_view() : scanner_.text());
        if (!array) return array.error();
        if (*array) header_.pieces.back().arrays[static_cast<std::size_t>(section_)].push_back(std::move(**array));
        return {};
    }

    Result<void> find_appended(const XmlTag& tag) {
        if (tag.end || tag.closed) return {};
        const auto encoding = tag.get("encoding");
        if (encoding != "raw" && encoding != "base64")
            return invalid_data(fmt::format("the encoding {} is not raw or base64", in_quotes(encoding)));
        header_.encoding.appended_raw = encoding == "raw";
        TextScanner rest(content_.substr(scanner_.position()));
        if (rest.at_end() || rest.rest().front() != '_')
            return invalid_data("the appended data does not start with an underscore");
        header_.encoding.appended = rest.rest().substr(1);
        return {};
    }

    std::string_view content_;
    XmlScanner scanner_;
    Header header_;
    Section section_ = Section::none;
    bool is_polydata_ = false;
};

const XmlArray* find_array(const std::vector<XmlArray>& arrays, std::string_view name) {
    const auto found = std::ranges::find(arrays, name, &XmlArray::name);
    return found == arrays.end() ? nullptr : &*found;
}

/// Makes the surface of one piece.
class PieceReader {
public:
    /// `appended_left`   bytes of appended data that no array has used yet
    PieceReader(const Piece& piece, const XmlEncoding& encoding, const Progress& progress, std::uint64_t& appended_left)
        : piece_(piece), encoding_(encoding), progress_(progress), appended_left_(appended_left) {}

    Result<Surface> read() {
        if (auto points = read_points(); !points) return points.error();
        for (const Section section : {Section::verts, Section::lines}) {
            // They make no triangles, but their cells come first in the cell data, and there can be no more than bytes.
            if (piece_.count(section) == 0) continue;
            auto offsets = read_indices(section, "offsets", piece_.count(section));
            if (!offsets) return offsets.error();
            parts_.cells.skip_cells(offsets->size());
        }
        if (auto polys = read_cells(Section::polys); !polys) return polys.error();
        if (auto strips = read_cells(Section::strips); !strips) return strips.error();
        if (auto data = read_data(Section::point_data, parts_.point_data); !data) return data.error();
        if (auto data = read_data(Section::cell_data, parts_.cell_data); !data) return data.error();
        return assemble(std::move(parts_));
    }

private:
    /// Arrays may not share appended data: a small file could otherwise fill any memory.
    Result<Array> load(const XmlArray& array) {
        auto values = load_array(array, encoding_, progress_);
        if (!values || array.form != XmlArray::Form::appended) return values;
        if (values->bytes() > appended_left_) {
            return invalid_data(
                fmt::format("the array {} shares appended data with other arrays", in_quotes(array.name)));
        }
        appended_left_ -= values->bytes();
        return values;
    }

    Result<void> read_points() {
        const auto count = piece_.count(Section::points);
        const auto& arrays = piece_.of(Section::points);
        if (count == 0) {
            parts_.positions = Array::own(std::vector<float>(), 3);
            return {};
        }
        if (arrays.empty())
            return invalid_data(fmt::format("{} points are announced, but there is no array of points", count));
        auto positions = load(arrays[0]);
        if (!positions) return positions.error();
        if (positions->components() != 3 || positions->tuples() != count || !is_floating(positions->type())) {
            return invalid_data(fmt::format("the points are {} tuples of {} {}, not {} of 3 floating ones",
                                            positions->tuples(), positions->components(), name_of(positions->type()),
                                            count));
        }
        parts_.positions = std::move(*positions);
        return {};
    }

    Result<std::vector<std::uint64_t>> read_indices(Section section, std::string_view name,
                                                    std::optional<std::uint64_t> count) {
        const auto section_name = section_names[static_cast<std::size_t>(section)];
        const auto* array = find_array(piece_.of(section), name);
        if (!array) return invalid_data(fmt::format("{} has no array \"{}\"", section_name, name));
        auto values = load(*array);
        if (!values) return values.error();
        if (is_floating(values->type()))
            return invalid_data(
                fmt::format("{} \"{}\" is {}, not integers", section_name, name, name_of(values->type())));
        if (count && values->size() != *count) {
            return invalid_data(
                fmt::format("{} \"{}\" has {} entries, not {}", section_name, name, values->size(), *count));
        }
        return as_indices(*values);
    }

    Result<void> read_cells(Section section) {
        if (piece_.count(section) == 0) return {};
        const auto offsets = read_indices(section, "offsets", piece_.count(section));
        if (!offsets) return offsets.error();
        const auto connectivity = read_indices(section, "connectivity", std::nullopt);
        if (!connectivity) return connectivity.error();
        std::uint64_t begin = 0;
        for (std::size_t i = 0; i < offsets->size(); ++i) {
            const std::uint64_t end = (*offsets)[i];
            if (end < begin || end > connectivity->size()) {
                return invalid_data(fmt::format("{} offsets[{}] is {} after {}, and there are {} corners",
                                                section_names[static_cast<std::size_t>(section)], i,
                                                static_cast<std::int64_t>(end), begin, connectivity->size()));
            }
            const auto corners = std::span(*connectivity).subspan(begin, end - begin);
            if (section == Section::polys) parts_.cells.add_polygon(corners);
            else parts_.cells.add_strip(corners);
            begin = end;
        }
        return {};
    }

    Result<void> read_data(Section section, std::vector<Attribute>& attributes) {
        const bool of_points = section == Section::point_data;
        const std::uint64_t tuples = of_points ? parts_.positions.tuples() : parts_.cells.cells();
        const auto& normals = piece_.normals[static_cast<std::size_t>(section)];
        for (const auto& array : piece_.of(section)) {
            Result<Array> values = Array();
            // VTK writes no bytes for arrays of nothing.
            if (tuples == 0)
                values = with_type(
                    array.type, [&](auto zero) { return Array::own(std::vector<decltype(zero)>(), array.components); });
            else values = load(array);
            if (!values) return values.error();
            attributes.push_back({array.name, std::move(*values), !normals.empty() && array.name == normals});
        }
        return {};
    }

    const Piece& piece_;
    const XmlEncoding& encoding_;
    const Progress& progress_;
    std::uint64_t& appended_left_;
    SurfaceParts parts_;
};

} // namespace

Result<Surface> parse_vtp(std::string_view content, const Progress& progress, std::string& compressed) {
    const auto header = HeaderReader(content).read();
    if (!header) return header.error();
    if (!header->compressor.empty()) {
        compressed = header->compressor;
        return invalid_data(fmt::format("the data is compressed ({}), which only VTK can read", in_quotes(compressed)));
    }
    if (header->pieces.empty()) return invalid_data("the file has no Piece");
    std::vector<Surface> surfaces;
    std::uint64_t appended_left = header->encoding.appended.size();
    for (const auto& piece : header->pieces) {
        auto surface = PieceReader(piece, header->encoding, progress, appended_left).read();
        if (!surface) return surface;
        surfaces.push_back(std::move(*surface));
    }
    if (surfaces.size() == 1) return std::move(surfaces.front());
    return join(surfaces, {});
}

} // namespace isotet::io
