// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/tetgen/read_tetgen.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "io/files/pace.hpp"
#include "io/files/text_scanner.hpp"
#include "io/pieces/cell_list.hpp"
#include "io/pieces/number_map.hpp"
#include "io/reader.hpp"

namespace isotet::io {

namespace {

constexpr std::string_view marker_name = "boundary_marker";

std::string attribute_name(std::string_view stem, std::int64_t index) { return fmt::format("{}_{}", stem, index); }

/// TetGen takes commas between numbers for blanks.
std::string with_blanks(std::string_view text) {
    std::string blanks;
    if (text.find(',') == std::string_view::npos) return blanks;
    blanks = text;
    std::ranges::replace(blanks, ',', ' ');
    return blanks;
}

/// One of the two files: records of one line each, after a header line.
class RecordFile {
public:
    RecordFile(std::string_view name, std::string_view text)
        : name_(name), blanks_(with_blanks(text)), scanner_(blanks_.empty() ? text : blanks_, '#') {}
    RecordFile(const RecordFile&) = delete;
    RecordFile& operator=(const RecordFile&) = delete;

    Error broken(const std::string& message) const {
        return {ErrorCode::invalid_data, fmt::format("the {} file {}", name_, message)};
    }
    Error broken_record(std::int64_t count, std::int64_t index) const {
        return broken(fmt::format("states {} records, but record {} is broken or missing at {}", count, index + 1,
                                  scanner_.where()));
    }

    /// Goes to the first word of the next record.
    TextScanner& next_record() {
        if (started_) scanner_.next_line();
        started_ = true;
        scanner_.at_end();
        return scanner_;
    }

    /// After the last record.
    Result<void> finish() {
        if (!next_record().at_end()) return broken("holds more records than it states, at " + scanner_.where());
        return {};
    }

    Result<void> check_count(std::int64_t count, std::int64_t numbers) const {
        const std::uint64_t most = (scanner_.left() + 1) / (2 * static_cast<std::uint64_t>(numbers));
        if (count >= 0 && static_cast<std::uint64_t>(count) <= most) return {};
        return broken(
            fmt::format("states {} records of {} numbers, but there is room for {} at most", count, numbers, most));
    }

private:
    std::string_view name_;
    std::string blanks_; ///< the text, where it has commas
    TextScanner scanner_;
    bool started_ = false;
};

constexpr std::int64_t max_attributes = 10000;

struct NodeHeader {
    std::int64_t count = 0, dimension = 3, attributes = 0, markers = 0;
};

Result<NodeHeader> read_header(RecordFile& file, NodeHeader header) {
    TextScanner& line = file.next_record();
    if (!line.number_of_line(header.count)) return file.broken("has no number of points at " + line.where());
    // What is not there has its default; what is behind is passed over, as in records.
    const bool all = line.number_of_line(header.dimension) && line.number_of_line(header.attributes) &&
                     line.number_of_line(header.markers);
    if (!all && !line.at_line_end()) return file.broken("has a broken first line at " + line.where());
    if (header.dimension != 3)
        return file.broken(fmt::format("says dimension {}, but 3 is the rule", header.dimension));
    if (header.attributes < 0 || header.attributes > max_attributes || header.markers < 0 || header.markers > 1) {
        return file.broken(
            fmt::format("says {} attributes and {} boundary markers, but 0 to {} and 0 or 1 are the rule",
                        header.attributes, header.markers, max_attributes));
    }
    if (auto room = file.check_count(header.count, 4 + header.attributes); !room) return room.error();
    return header;
}

struct ElementHeader {
    std::int64_t count = 0, nodes = 4, attributes = 0;
};

Result<ElementHeader> read_header(RecordFile& file, ElementHeader header) {
    TextScanner& line = file.next_record();
    if (!line.number_of_line(header.count)) return file.broken("has no number of tets at " + line.where());
    const bool all = line.number_of_line(header.nodes) && line.number_of_line(header.attributes);
    if (!all && !line.at_line_end()) return file.broken("has a broken first line at " + line.where());
    if (header.nodes != 4 && header.nodes != 10) {
        return file.broken(fmt::format("says {} nodes a tet, but 4 or 10 is the rule", header.nodes));
    }
    if (header.attributes < 0 || header.attributes > max_attributes) {
        return file.broken(
            fmt::format("says {} attributes, but 0 to {} are the rule", header.attributes, max_attributes));
    }
    if (auto room = file.check_count(header.count, 1 + header.nodes + header.attributes); !room) return room.error();
    return header;
}

/// The columns of attributes of one file; those that are not wanted are skipped.
class Attributes {
public:
    Attributes(std::string_view stem, std::int64_t count, Association association, const ReadOptions& options,
               std::int64_t rows) {
        for (std::int64_t i = 0; i < count; ++i) {
            Column column{attribute_name(stem, i), false, {}};
            column.wanted = wanted(options, association, column.name);
            if (column.wanted) column.values.reserve(static_cast<std::size_t>(rows));
            columns_.push_back(std::move(column));
        }
    }
    bool read(TextScanner& line) {
        for (Column& column : columns_) {
            double value = 0;
            if (!line.number_of_line(value)) return false;
            if (column.wanted) column.values.push_back(value);
        }
        return true;
    }
    void give(std::vector<Field>& fields) {
        for (Column& column : columns_) {
            if (column.wanted) fields.push_back({std::move(column.name), Array::own(std::move(column.values))});
        }
    }

private:
    struct Column {
        std::string name;
        bool wanted;
        std::vector<double> values;
    };
    std::vector<Column> columns_;
};

/// As int32 where all are whole numbers that fit.
Array as_integers(std::vector<double> numbers) {
    constexpr double most = std::numeric_limits<std::int32_t>::max();
    const bool whole = std::ranges::all_of(numbers, [](double x) { return std::abs(x) <= most && x == std::floor(x); });
    if (!whole) return Array::own(std::move(numbers));
    return Array::own(std::vector<std::int32_t>(numbers.begin(), numbers.end()));
}

Result<void> read_nodes(RecordFile& file, const NodeHeader& header, const ReadOptions& options, Pace& pace, Grid& grid,
                        NumberMap& numbers) {
    Attributes attributes("attribute", header.attributes, Association::point, options, header.count);
    const bool wants_markers = header.markers > 0 && wanted(options, Association::point, marker_name);
    std::vector<double> markers; // other programs write any number
    std::vector<double> points;
    points.reserve(3 * static_cast<std::size_t>(header.count));
    for (std::int64_t i = 0; i < header.count; ++i) {
        TextScanner& line = file.next_record();
        std::int64_t number = 0;
        double x = 0, y = 0, z = 0;
        double marker = 0;
        if (!line.number_of_line(number) || !line.number_of_line(x) || !line.number_of_line(y) ||
            !line.number_of_line(z) || !attributes.read(line) || (header.markers > 0 && !line.number_of_line(marker))) {
            return file.broken_record(header.count, i);
        }
        numbers.add(number);
        points.insert(points.end(), {x, y, z});
        if (wants_markers) markers.push_back(marker);
        if (!pace.goes_on(line.position())) return Pace::cancelled();
    }
    if (auto finished = file.finish(); !finished) return finished;
    if (const auto closed = numbers.close("point"); !closed) return file.broken("is broken: " + closed.error().message);
    grid.points = Array::own(std::move(points), 3);
    attributes.give(grid.point_fields);
    if (wants_markers) grid.point_fields.push_back({std::string(marker_name), as_integers(std::move(markers))});
    return {};
}

/// Where TetGen has the nodes of a tetrahedron of ten that VTK numbers 4 to 9; other programs write VTK's order.
constexpr std::array<std::uint8_t, 6> tetgen_order{6, 7, 9, 5, 8, 4}, same_order{4, 5, 6, 7, 8, 9};

/// How far the nodes are from the middles of their edges: the sum of the squares.
double distance_from_middles(const Array& points, const std::array<std::uint64_t, 10>& tet,
                             const std::array<std::uint8_t, 6>& order) {
    static constexpr std::array<std::array<std::uint8_t, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
    double sum = 0;
    for (std::size_t e = 0; e < 6; ++e)
        for (std::size_t k = 0; k < 3; ++k) {
            const double middle = (points.at(tet[edges[e][0]], k) + points.at(tet[edges[e][1]], k)) / 2;
            const double distance = points.at(tet[order[e]], k) - middle;
            sum += distance * distance;
        }
    return sum;
}

/// The nodes of ten stand in the order in which they are nearer to the middles of edges, TetGen's where both fit.
void add_quadratic_tet(CellList& cells, const Array& points, const std::array<std::uint64_t, 10>& tet) {
    const bool same = distance_from_middles(points, tet, same_order) < distance_from_middles(points, tet, tetgen_order);
    for (std::size_t i = 0; i < 4; ++i) cells.corner(tet[i]);
    for (const std::uint8_t node : same ? same_order : tetgen_order) cells.corner(tet[node]);
}

Result<void> read_elements(RecordFile& file, const ElementHeader& header, const ReadOptions& options,
                           const NumberMap& points, std::size_t start, Pace& pace, Grid& grid) {
    constexpr std::uint8_t tetrahedron = 10, quadratic_tetrahedron = 24;
    Attributes attributes("region", header.attributes, Association::cell, options, header.count);
    CellList cells(points.size());
    cells.reserve(static_cast<std::uint64_t>(header.count * header.nodes));
    for (std::int64_t i = 0; i < header.count; ++i) {
        TextScanner& line = file.next_record();
        std::int64_t number = 0;
        if (!line.number_of_line(number)) return file.broken_record(header.count, i);
        cells.start(header.nodes == 4 ? tetrahedron : quadratic_tetrahedron, static_cast<std::uint32_t>(header.nodes));
        std::array<std::uint64_t, 10> tet{};
        for (std::int64_t k = 0; k < header.nodes; ++k) {
            std::int64_t corner = 0;
            if (!line.number_of_line(corner)) return file.broken_record(header.count, i);
            const std::uint64_t point = points.find(corner);
            if (point == NumberMap::none) {
                return file.broken(
                    fmt::format("has tet {} with point {}, which is not in the .node file", number, corner));
            }
            tet[static_cast<std::size_t>(k)] = point;
        }
        if (header.nodes == 10) add_quadratic_tet(cells, grid.points, tet);
        else
            for (std::size_t k = 0; k < 4; ++k) cells.corner(tet[k]);
        if (!attributes.read(line)) return file.broken_record(header.count, i);
        if (!pace.goes_on(start + line.position())) return Pace::cancelled();
    }
    if (auto finished = file.finish(); !finished) return finished;
    grid.cells = cells.finish();
    attributes.give(grid.cell_fields);
    return {};
}

FileInfo info_of(const NodeHeader& nodes, const ElementHeader& elements) {
    FileInfo info;
    info.format = "tetgen";
    for (std::int64_t i = 0; i < nodes.attributes; ++i) {
        info.fields.push_back({attribute_name("attribute", i), Association::point, ScalarType::float64, 1});
    }
    if (nodes.markers > 0) info.fields.push_back({std::string(marker_name), Association::point, ScalarType::int32, 1});
    for (std::int64_t i = 0; i < elements.attributes; ++i) {
        info.fields.push_back({attribute_name("region", i), Association::cell, ScalarType::float64, 1});
    }
    return info;
}

} // namespace

Result<FileInfo> inspect_tetgen(std::string_view nodes, std::string_view elements, const Progress&) {
    RecordFile node_file(".node", nodes), element_file(".ele", elements);
    const auto node_header = read_header(node_file, NodeHeader{});
    if (!node_header) return node_header.error();
    const auto element_header = read_header(element_file, ElementHeader{});
    if (!element_header) return element_header.error();
    return info_of(*node_header, *element_header);
}

Result<ReadResult> parse_tetgen(std::string_view nodes, std::string_view elements, const ReadOptions& options,
                                const Progress& progress) {
    RecordFile node_file(".node", nodes), element_file(".ele", elements);
    const auto node_header = read_header(node_file, NodeHeader{});
    if (!node_header) return node_header.error();
    const auto element_header = read_header(element_file, ElementHeader{});
    if (!element_header) return element_header.error();

    ReadResult result;
    result.info = info_of(*node_header, *element_header);
    if (const auto step = choose_step(result.info, options); !step) return step.error();
    Pace pace(progress, nodes.size() + elements.size());
    NumberMap numbers;
    if (const auto read = read_nodes(node_file, *node_header, options, pace, result.grid, numbers); !read)
        return read.error();
    if (const auto read =
            read_elements(element_file, *element_header, options, numbers, nodes.size(), pace, result.grid);
        !read) {
        return read.error();
    }
    for (const auto& [name, text] : {std::pair(".node", nodes), std::pair(".ele", elements)}) {
        if (text.empty() || is_space(text.back()) || text.substr(text.rfind('\n') + 1).find('#') != text.npos) continue;
        result.notes.push_back(
            fmt::format("the {} file does not end with a line end: its last number may be cut short", name));
    }
    return result;
}

} // namespace isotet::io
