// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_xml/write_vtk_xml.hpp"

#include <utility>

#include <fmt/core.h>

#include "io/vtk_xml/pack_column.hpp"
#include "io/write/write_names.hpp"

namespace isotet::io {
namespace {

std::string_view xml_type(ScalarType type) {
    switch (type) {
    case ScalarType::int8: return "Int8";
    case ScalarType::uint8: return "UInt8";
    case ScalarType::int16: return "Int16";
    case ScalarType::uint16: return "UInt16";
    case ScalarType::int32: return "Int32";
    case ScalarType::uint32: return "UInt32";
    case ScalarType::int64: return "Int64";
    case ScalarType::uint64: return "UInt64";
    case ScalarType::float32: return "Float32";
    case ScalarType::float64: break;
    }
    return "Float64";
}

} // namespace

VtkXmlFile::VtkXmlFile(std::string_view dataset, Compression compression)
    : dataset_(dataset), compression_(compression) {
    constexpr std::string_view compressors[] = {"", " compressor=\"vtkZLibDataCompressor\"",
                                                " compressor=\"vtkLZ4DataCompressor\""};
    lines_ = fmt::format("<?xml version=\"1.0\"?>\n"
                         "<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" "
                         "header_type=\"UInt64\"{1}>\n<{0}>\n",
                         dataset, compressors[static_cast<std::size_t>(compression)]);
}

void VtkXmlFile::line(std::string_view text) {
    lines_ += text;
    lines_ += '\n';
}

void VtkXmlFile::array(const Column& column) {
    add(column, fmt::format(" NumberOfComponents=\"{}\"", column.components));
}

void VtkXmlFile::array_of_file(const Column& column) {
    add(column, fmt::format(" NumberOfComponents=\"{}\" NumberOfTuples=\"{}\"", column.components, column.tuples));
}

void VtkXmlFile::flat_array(const Column& column) { add(column, {}); }

void VtkXmlFile::add(const Column& column, std::string_view components) {
    std::string attributes =
        fmt::format(R"(type="{}" Name="{}"{})", xml_type(column.type), xml_name(column.name), components);
    bytes_ += lines_.size() + attributes.size() + sizeof(std::uint64_t) + column.bytes();
    entries_.push_back({std::exchange(lines_, {}), std::move(attributes), &column});
}

std::string VtkXmlFile::header(const std::vector<std::uint64_t>& bytes_of_columns) const {
    std::string header;
    std::uint64_t offset = 0;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        header += entries_[i].lines;
        header += fmt::format("<DataArray {} format=\"appended\" offset=\"{}\"/>\n", entries_[i].attributes, offset);
        offset += bytes_of_columns[i];
    }
    return header + lines_ + fmt::format("</{}>\n<AppendedData encoding=\"raw\">\n_", dataset_);
}

void VtkXmlFile::write(WriteStream& stream) const {
    std::vector<PackedColumn> packed;
    std::vector<std::uint64_t> bytes;
    for (const Entry& entry : entries_)
        if (compression_ == Compression::none) {
            bytes.push_back(sizeof(std::uint64_t) + entry.column->bytes());
        } else {
            packed.push_back(pack_column(*entry.column, compression_, stream.progress()));
            bytes.push_back(packed.back().bytes());
        }
    stream.text(header(bytes));
    for (std::size_t i = 0; i < entries_.size(); ++i)
        if (compression_ == Compression::none) {
            stream.number(entries_[i].column->bytes(), std::endian::little);
            stream.column(*entries_[i].column, std::endian::little);
        } else {
            packed[i].write(stream);
        }
    stream.text("\n</AppendedData>\n</VTKFile>\n");
}

} // namespace isotet::io
