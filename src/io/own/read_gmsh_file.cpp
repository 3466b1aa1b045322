// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The frame of an MSH file: $MeshFormat and where each section begins and ends.
#include <algorithm>
#include <string>

#include <fmt/core.h>

#include "io/own/read_gmsh_parts.hpp"

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
    const std::string end_word = "$End" + std::string(section.name);
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

Result<void> read_format(const Section& section, File& file) {
    TextScanner scanner(section.body);
    double version = 0;
    std::int32_t type = 0, data_size = 0;
    if (!scanner.number(version) || !scanner.number(type) || !scanner.number(data_size)) {
        return broken(section, "has " + scanner.where() + " where version, file type and data size should stand");
    }
    file.version_4 = version == 4.1;
    if (!file.version_4 && !(version >= 2 && version < 3)) {
        return broken(section,
                      fmt::format("says version {}, but isotet reads 2.0 to 2.2 and 4.1 (gmsh -save -format msh41 "
                                  "converts)",
                                  version));
    }
    if (type != 0 && type != 1)
        return broken(section, fmt::format("says file type {}, but 0 (ascii) and 1 (binary) are all there are", type));
    file.binary = type == 1;
    if (data_size != 8 && !(file.version_4 && data_size == 4)) {
        return broken(section, fmt::format("says data size {}, but 8 is the rule", data_size));
    }
    if (!file.binary) return {};
    file.number_bytes = file.version_4 ? static_cast<std::size_t>(data_size) : 4;
    scanner.next_line();
    std::int32_t one = 0;
    if (!ByteReader(scanner.rest()).read(one))
        return broken(section, "ends before the number 1 that tells the byte order");
    file.swapped = one == 0x01000000;
    if (one != 1 && !file.swapped)
        return broken(section, fmt::format("has {} where the number 1 tells the byte order", one));
    return {};
}

} // namespace

const Section* File::find(std::string_view name) const {
    const auto found = std::find_if(sections.begin(), sections.end(), [&](const Section& s) { return s.name == name; });
    return found == sections.end() ? nullptr : &*found;
}

Error broken(const Section& section, const std::string& message) {
    return {ErrorCode::invalid_data, fmt::format("${}: {}", section.name.substr(0, 40), message)};
}

Result<File> open(std::string_view bytes) {
    File file;
    for (std::size_t at = next_header(bytes, 0); at != std::string_view::npos;) {
        file.sections.push_back(section_at(bytes, at));
        const Section& section = file.sections.back();
        if (section.name == "NOD") {
            return broken(section, "is version 1 of the format, but isotet reads 2.0 to 2.2 and 4.1");
        }
        at = section.ended ? next_header(bytes, section.start + section.body.size() + 1) : std::string_view::npos;
    }
    const Section* format = file.find("MeshFormat");
    if (!format) return Error{ErrorCode::invalid_data, "has no $MeshFormat section, so it is no MSH file"};
    if (!format->ended) return broken(*format, "has no $EndMeshFormat: the file is cut short");
    if (const auto read = read_format(*format, file); !read) return read.error();
    return file;
}

Result<const Section*> only_section(const File& file, std::string_view name) {
    const Section* section = file.find(name);
    if (!section) {
        return Error{ErrorCode::invalid_data, fmt::format("has no ${} section{}", name,
                                                          file.sections.back().ended ? "" : ": the file is cut short")};
    }
    const auto same = [&](const Section& other) { return other.name == name; };
    if (std::count_if(file.sections.begin(), file.sections.end(), same) > 1) {
        return broken(*section, "occurs twice, but a file has one");
    }
    return section;
}

std::string ByteSource::where() const { return fmt::format("byte {} of the section", reader_.position()); }

} // namespace isotet::io::gmsh
