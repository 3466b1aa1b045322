// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The frame of an MSH file: $MeshFormat and where each section begins and ends.
#include <algorithm>
#include <string>

#include <fmt/core.h>

#include "io/gmsh/read_gmsh_parts.hpp"

namespace isotet::io::gmsh {

namespace {

/// The position of the next $ that starts a line, or npos.
std::size_t next_header(std::string_view bytes, std::size_t from) {
    for (std::size_t at = bytes.find('$', from); at != std::string_view::npos; at = bytes.find('$', at + 1)) {
        if (at == 0 || bytes[at - 1] == '\n' || bytes[at - 1] == '\r') return at;
    }
    return std::string_view::npos;
}

Section section_at(std::string_view bytes, std::size_t dollar) {
    Section section;
    const std::size_t name_end = std::min(bytes.find_first_of(" \t\r\n", dollar), bytes.size());
    section.name = bytes.substr(dollar + 1, name_end - dollar - 1);
    section.start = std::min(bytes.find('\n', name_end), bytes.size() - 1) + 1;
    const std::string end_word = end_of(section.name);
    std::size_t end = bytes.find(end_word, section.start);
    // $EndElementData does not end $Element.
    while (end != std::string_view::npos && end + end_word.size() < bytes.size() &&
           !is_space(bytes[end + end_word.size()])) {
        end = bytes.find(end_word, end + 1);
    }
    section.ended = end != std::string_view::npos;
    section.body = bytes.substr(section.start, section.ended ? end - section.start : std::string_view::npos);
    return section;
}

struct Format {
    Version version;
    Form form;
};

Result<Format> read_format(const Section& section) {
    TextScanner scanner(section.body);
    double version = 0;
    std::int32_t type = 0, data_size = 0;
    if (!scanner.number(version) || !scanner.number(type) || !scanner.number(data_size)) {
        return broken(section, "has " + scanner.where() + " where version, file type and data size should stand");
    }
    Format format{version == 4.1 ? Version::v41 : version == 4 ? Version::v40 : Version::v2, {}};
    if (format.version == Version::v2 && !(version >= 2 && version < 3)) {
        return broken(section, fmt::format("says version {}, but isotet reads 1.0, 2.0 to 2.2, 4.0 and 4.1 (gmsh -save "
                                           "-format msh41 converts)",
                                           version));
    }
    if (type != 0 && type != 1)
        return broken(section, fmt::format("says file type {}, but 0 (ascii) and 1 (binary) are all there are", type));
    if (data_size != 8 && !(format.version == Version::v41 && data_size == 4)) {
        return broken(section, fmt::format("says data size {}, but 8 is the rule", data_size));
    }
    format.form.binary = type == 1;
    if (!format.form.binary) return format;
    const auto size = static_cast<std::size_t>(data_size);
    format.form.number_bytes = format.version == Version::v41 ? size : 4;
    format.form.count_bytes = format.version == Version::v2 ? 4 : size;
    scanner.next_line();
    std::int32_t one = 0;
    if (!ByteReader(scanner.rest()).read(one))
        return broken(section, "ends before the number 1 that tells the byte order");
    format.form.swapped = one == 0x01000000;
    if (one != 1 && !format.form.swapped)
        return broken(section, fmt::format("has {} where the number 1 tells the byte order", one));
    return format;
}

} // namespace

const Section* File::find(std::string_view name) const {
    const auto found = std::find_if(sections.begin(), sections.end(), [&](const Section& s) { return s.name == name; });
    return found == sections.end() ? nullptr : &*found;
}

std::string_view File::name_of_nodes() const {
    if (version == Version::v1) return "NOD";
    return version == Version::v2 && find("ParametricNodes") ? "ParametricNodes" : "Nodes";
}

std::string end_of(std::string_view name) {
    return (name == "NOD" || name == "ELM" ? "$END" : "$End") + std::string(name);
}

Error broken(const Section& section, const std::string& message) {
    return {ErrorCode::invalid_data, fmt::format("${}: {}", section.name.substr(0, 40), message)};
}

Result<File> open(std::string_view bytes) {
    File file;
    std::optional<Format> format;
    for (std::size_t at = next_header(bytes, 0); at != std::string_view::npos;) {
        Section section = section_at(bytes, at);
        if (section.name == "MeshFormat") {
            if (!section.ended) return broken(section, "has no $EndMeshFormat: the file is cut short");
            const auto read = read_format(section);
            if (!read) return read.error();
            if (format && format->version != read->version)
                return broken(section, "occurs twice, with different versions");
            format = *read;
            file.version = format->version;
        } else if (section.name == "NOD" && !format) {
            file.version = Version::v1;
            format = Format{Version::v1, {}};
        }
        if (format) section.form = format->form;
        file.sections.push_back(section);
        at = section.ended ? next_header(bytes, section.start + section.body.size() + 1) : std::string_view::npos;
    }
    if (!format) return Error{ErrorCode::invalid_data, "has no $MeshFormat section, so it is no MSH file"};
    return file;
}

Result<const Section*> first_section(const File& file, std::string_view name) {
    const Section* section = file.find(name);
    if (!section) {
        return Error{ErrorCode::invalid_data, fmt::format("has no ${} section{}", name,
                                                          file.sections.back().ended ? "" : ": the file is cut short")};
    }
    return section;
}

std::string ByteSource::where() const { return fmt::format("byte {} of the section", reader_.position()); }

} // namespace isotet::io::gmsh
