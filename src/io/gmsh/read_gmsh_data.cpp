// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// $NodeData, $ElementData and $ElementNodeData of MSH files: headers are text, values text or binary, the same in all
// versions.
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "io/gmsh/read_gmsh_parts.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::gmsh {

namespace {

/// A string tag stands on a line of its own, in quotation marks or without.
std::string_view unquoted(std::string_view line) {
    if (line.size() >= 2 && line.front() == '"' && line.back() == '"') return line.substr(1, line.size() - 2);
    return line;
}

bool read_tags(TextScanner& scanner, DataSection& data) {
    std::int32_t count = 0;
    if (!scanner.number(count) || count < 0) return false;
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
        if (i == 3) data.partition = tag;
    }
    return true;
}

std::optional<DataKind> kind_of(std::string_view name) {
    if (name == "NodeData") return DataKind::node;
    if (name == "ElementData") return DataKind::element;
    if (name == "ElementNodeData") return DataKind::element_node;
    return std::nullopt;
}

Result<DataSection> header_of(const Section& section, DataKind kind) {
    DataSection data;
    data.section = &section;
    data.kind = kind;
    TextScanner scanner(section.body);
    if (!read_tags(scanner, data)) return broken(section, "has a broken list of tags at " + scanner.where());
    if (data.name.empty()) data.name = section.name; // Gmsh takes data without a name, too
    // Gmsh knows 1, 3 and 9; a limit keeps a broken file from asking for more memory than there is.
    constexpr std::int32_t max_components = 64;
    if (data.components < 1 || data.components > max_components || data.count < 0) {
        return broken(section, fmt::format("{} states {} components and {} values, but 1 to {} components are the rule",
                                           in_quotes(data.name), data.components, data.count, max_components));
    }
    if (std::isnan(data.time)) return broken(section, in_quotes(data.name) + " has a time that is not a number");
    scanner.next_line();
    data.values = scanner.position();
    return data;
}

Error not_there(const DataSection& data, const char* what, std::int64_t number) {
    return broken(*data.section, fmt::format("{} has a value for {} {}, which the file does not have",
                                             in_quotes(data.name), what, number));
}

Error broken_at(const DataSection& data, const char* what, std::int32_t index, const std::string& where) {
    return broken(*data.section, fmt::format("{} states values of {} {}s, but number {} is broken or missing at {}",
                                             in_quotes(data.name), data.count, what, index + 1, where));
}

/// `numbers`   at least so many precede the values of a node or element
template <class Source>
Result<void> check_count(const Source& source, const DataSection& data, const char* what, std::size_t integers) {
    const std::uint64_t most = source.records_left(integers, 1, static_cast<std::size_t>(data.components));
    if (static_cast<std::uint64_t>(data.count) <= most) return {};
    return broken(*data.section, fmt::format("{} states values of {} {}s, but there is room for {} at most",
                                             in_quotes(data.name), data.count, what, most));
}

template <class Source>
Result<void> read_from(Source source, const DataSection& data, const NumberMap& numbers, Pace& pace,
                       std::vector<double>& values, std::uint64_t& replaced) {
    const char* what = data.kind == DataKind::node ? "node" : "element";
    const auto components = static_cast<std::size_t>(data.components);
    if (auto fits = check_count(source, data, what, 0); !fits) return fits;
    for (std::int32_t i = 0; i < data.count; ++i) {
        std::int64_t number = 0;
        bool whole = source.number(number);
        const std::uint64_t position = whole ? numbers.find(number) : 0;
        if (position == NumberMap::none) return not_there(data, what, number);
        bool differs = false;
        for (std::size_t c = 0; c < components; ++c) {
            double& value = values[position * components + c];
            const double before = value;
            whole = whole && source.real(value);
            differs = differs || (!std::isnan(before) && before != value);
        }
        if (!whole) return broken_at(data, what, i, source.where());
        replaced += differs ? 1 : 0;
        if (!pace.goes_on(source.position())) return Pace::cancelled();
    }
    return finish_section(*data.section, source);
}

} // namespace

std::vector<DataSection> data_sections(const File& file, FileInfo& info) {
    std::vector<DataSection> result;
    for (const Section& section : file.sections) {
        const auto kind = kind_of(section.name);
        if (!kind) continue;
        auto data = header_of(section, *kind);
        if (data) result.push_back(*std::move(data));
        else leave_out(info, {"section", "$" + std::string(section.name), data.error().message});
    }
    return result;
}

Result<void> read_values(const DataSection& data, const NumberMap& numbers, Pace& pace, std::vector<double>& values,
                         std::uint64_t& replaced) {
    const Section& section = *data.section;
    if (section.form.binary)
        return read_from(ByteSource(section, data.values, 4), data, numbers, pace, values, replaced);
    return read_from(TextSource(section, data.values), data, numbers, pace, values, replaced);
}

namespace {

template <class Source>
Result<void> read_corners_from(Source source, const DataSection& data, const Mesh& mesh, Pace& pace,
                               NodeMeans& means) {
    if (auto fits = check_count(source, data, "element", 1); !fits) return fits;
    const auto components = static_cast<std::size_t>(data.components);
    for (std::int32_t i = 0; i < data.count; ++i) {
        std::int64_t number = 0;
        std::int32_t corners = 0;
        if (!source.number(number) || !source.integer(corners)) return broken_at(data, "element", i, source.where());
        const std::uint64_t element = mesh.elements.find(number);
        if (element == NumberMap::none) return not_there(data, "element", number);
        const std::uint64_t begin = element == 0 ? 0 : mesh.element_ends[element - 1];
        const std::uint64_t nodes = mesh.element_ends[element] - begin;
        if (corners < 1 || static_cast<std::uint64_t>(corners) > nodes)
            return broken(*data.section, fmt::format("{} has values at {} nodes of element {}, which has {}",
                                                     in_quotes(data.name), corners, number, nodes));
        for (std::uint64_t k = begin; k < begin + static_cast<std::uint64_t>(corners); ++k) {
            const std::uint64_t point = mesh.element_points[k];
            means.count(point);
            for (std::size_t c = 0; c < components; ++c) {
                double value = 0;
                if (!source.real(value)) return broken_at(data, "element", i, source.where());
                means.add(point, c, value);
            }
        }
        if (!pace.goes_on(source.position())) return Pace::cancelled();
    }
    return finish_section(*data.section, source);
}

} // namespace

Result<void> read_corner_values(const DataSection& data, const Mesh& mesh, Pace& pace, NodeMeans& means) {
    const Section& section = *data.section;
    if (section.form.binary) return read_corners_from(ByteSource(section, data.values, 4), data, mesh, pace, means);
    return read_corners_from(TextSource(section, data.values), data, mesh, pace, means);
}

} // namespace isotet::io::gmsh
