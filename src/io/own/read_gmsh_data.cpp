// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// $NodeData and $ElementData of MSH files: headers are text, values text or binary, the same in all versions.
#include <fmt/core.h>

#include "io/own/read_gmsh_parts.hpp"

namespace isotet::io::gmsh {

namespace {

/// A string tag stands on a line of its own, in quotation marks or without.
std::string_view unquoted(std::string_view line) {
    if (line.size() >= 2 && line.front() == '"' && line.back() == '"') return line.substr(1, line.size() - 2);
    return line;
}

bool read_tags(TextScanner& scanner, DataSection& data) {
    std::int32_t count = 0;
    if (!scanner.number(count) || count < 1) return false;
    for (std::int32_t i = 0; i < count; ++i) {
        const std::string_view line = scanner.line();
        if (line.empty()) return false;
        if (i == 0) data.name = unquoted(line);
    }
    if (!scanner.number(count)) return false;
    for (std::int32_t i = 0; i < count; ++i) {
        double tag = 0;
        if (!scanner.number(tag)) return false;
        if (i == 0) data.time = tag;
    }
    if (!scanner.number(count) || count < 3) return false;
    for (std::int32_t i = 0; i < count; ++i) {
        std::int32_t tag = 0;
        if (!scanner.number(tag)) return false;
        if (i == 0) data.step = tag;
        if (i == 1) data.components = tag;
        if (i == 2) data.count = tag;
    }
    return true;
}

template <class Source>
Result<void> read_from(Source source, const DataSection& data, const NumberMap& numbers, Pace& pace,
                       std::vector<double>& values) {
    const Section& section = *data.section;
    const char* what = data.association == Association::point ? "node" : "element";
    const auto components = static_cast<std::size_t>(data.components);
    const std::uint64_t most = source.records_left(0, 1, components);
    if (static_cast<std::uint64_t>(data.count) > most) {
        return broken(section, fmt::format("{} states values of {} {}s, but there is room for {} at most",
                                           in_quotes(data.name), data.count, what, most));
    }
    for (std::int32_t i = 0; i < data.count; ++i) {
        std::int64_t number = 0;
        bool whole = source.number(number);
        const std::uint64_t position = whole ? numbers.find(number) : 0;
        if (position == NumberMap::none) {
            return broken(section, fmt::format("{} has a value for {} {}, which the file does not have",
                                               in_quotes(data.name), what, number));
        }
        for (std::size_t c = 0; c < components; ++c) whole = whole && source.real(values[position * components + c]);
        if (!whole) {
            return broken(section, fmt::format("{} states values of {} {}s, but number {} is broken or missing at {}",
                                               in_quotes(data.name), data.count, what, i + 1, source.where()));
        }
        if (!pace.goes_on(source.position())) return Pace::cancelled();
    }
    return finish_section(section, source);
}

} // namespace

Result<std::vector<DataSection>> data_sections(const File& file) {
    std::vector<DataSection> result;
    for (const Section& section : file.sections) {
        const bool point = section.name == "NodeData";
        if (!point && section.name != "ElementData") continue;
        DataSection data;
        data.section = &section;
        data.association = point ? Association::point : Association::cell;
        TextScanner scanner(section.body);
        if (!read_tags(scanner, data)) return broken(section, "has a broken list of tags at " + scanner.where());
        // Gmsh knows 1, 3 and 9; a limit keeps a broken file from asking for more memory than there is.
        constexpr std::int32_t max_components = 64;
        if (data.components < 1 || data.components > max_components || data.count < 0) {
            return broken(section,
                          fmt::format("{} states {} components and {} values, but 1 to {} components are the rule",
                                      in_quotes(data.name), data.components, data.count, max_components));
        }
        scanner.next_line();
        data.values = scanner.position();
        result.push_back(std::move(data));
    }
    return result;
}

Result<void> read_values(const File& file, const DataSection& data, const NumberMap& numbers, Pace& pace,
                         std::vector<double>& values) {
    if (file.binary) return read_from(ByteSource(file, *data.section, data.values, 4), data, numbers, pace, values);
    return read_from(TextSource(file, *data.section, data.values), data, numbers, pace, values);
}

} // namespace isotet::io::gmsh
