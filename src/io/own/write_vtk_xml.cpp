// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/own/write_vtk_xml.hpp"

#include <fmt/core.h>

#include "io/own/write_names.hpp"

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

VtkXmlFile::VtkXmlFile(std::string_view dataset)
    : dataset_(dataset),
      header_(fmt::format("<?xml version=\"1.0\"?>\n"
                          "<VTKFile type=\"{0}\" version=\"1.0\" byte_order=\"LittleEndian\" "
                          "header_type=\"UInt64\">\n<{0}>\n",
                          dataset)) {}

void VtkXmlFile::line(std::string_view text) {
    header_ += text;
    header_ += '\n';
}

void VtkXmlFile::array(const Column& column) {
    add(column, fmt::format(" NumberOfComponents=\"{}\"", column.components));
}

void VtkXmlFile::flat_array(const Column& column) { add(column, {}); }

void VtkXmlFile::add(const Column& column, std::string_view components) {
    line(fmt::format(R"(<DataArray type="{}" Name="{}"{} format="appended" offset="{}"/>)", xml_type(column.type),
                     xml_name(column.name), components, offset_));
    columns_.push_back(&column);
    offset_ += sizeof(std::uint64_t) + column.bytes();
}

void VtkXmlFile::write(WriteStream& stream) const {
    stream.text(header_);
    stream.text(fmt::format("</{}>\n<AppendedData encoding=\"raw\">\n_", dataset_));
    for (const auto* column : columns_) {
        stream.number(column->bytes(), std::endian::little);
        stream.column(*column, std::endian::little);
    }
    stream.text("\n</AppendedData>\n</VTKFile>\n");
}

} // namespace isotet::io
