// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Records of an .frd file: numbers stand in columns, without space between them where they are negative.
#include "io/frd/read_frd.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/pace.hpp"
#include "io/frd/read_frd_index.hpp"
#include "io/pieces/cell_list.hpp"
#include "io/pieces/loaded.hpp"
#include "io/pieces/number_map.hpp"
#include "io/reader.hpp"

namespace isotet::io {

namespace {

using frd::Block;
using frd::Form;

constexpr std::size_t key_width = 3, real_width = 12, reals_on_line = 6;

std::size_t number_width(const Block& block) { return block.form == Form::short_text ? 5 : 10; }

Error wrong_at(std::size_t byte, const std::string& what) {
    return invalid_data(fmt::format("before byte {}: {}", byte, what));
}

template <class Number>
Number stored(std::string_view file, std::size_t at) {
    Number value{};
    std::memcpy(&value, file.data() + at, sizeof value);
    return value;
}

/// Calls take(number, reals) for each record of so many reals. `reals` is a span of doubles, or of what binary blocks hold.
template <class Take>
Result<void> each_text_record(std::string_view file, const Block& block, std::size_t reals, const Take& take) {
    std::vector<double> values(reals);
    const std::size_t width = number_width(block);
    std::uint64_t records = 0;
    for (std::size_t at = block.begin; at < block.end;) {
        std::string_view line = frd::take_line(file, at);
        std::int64_t number = 0;
        if (!line.starts_with(" -1") || !frd::number_at(line, key_width, width, number))
            return wrong_at(
                at, fmt::format("a record begins with {}, not with -1 and a number", in_quotes(line.substr(0, 16))));
        for (std::size_t i = 0; i < reals; ++i) {
            if (i > 0 && i % reals_on_line == 0) {
                line = at < block.end ? frd::take_line(file, at) : std::string_view();
                if (!line.starts_with(" -2"))
                    return wrong_at(at, fmt::format("node {} has {} values, but must have {}", number, i, reals));
            }
            if (!frd::number_at(line, key_width + width + i % reals_on_line * real_width, real_width, values[i]))
                return wrong_at(at,
                                fmt::format("value {} of node {} is no number: {}", i + 1, number, in_quotes(line)));
        }
        if (auto done = take(number, std::span<const double>(values)); !done) return done;
        ++records;
    }
    if (records == block.count) return {};
    return wrong_at(block.end, fmt::format("there are {} records, but {} are announced", records, block.count));
}

template <class Real, class Take>
Result<void> each_binary_record(std::string_view file, const Block& block, std::size_t reals, const Take& take) {
    std::vector<double> values(reals);
    std::size_t at = block.begin;
    for (std::uint64_t i = 0; i < block.count; ++i) {
        const auto number = stored<std::int32_t>(file, at);
        at += 4;
        for (std::size_t k = 0; k < reals; ++k, at += sizeof(Real)) values[k] = stored<Real>(file, at);
        if (auto done = take(number, std::span<const double>(values)); !done) return done;
    }
    return {};
}

template <class Take>
Result<void> each_record(std::string_view file, const Block& block, std::size_t reals, const Take& take) {
    if (block.form == Form::binary_float) return each_binary_record<float>(file, block, reals, take);
    if (block.form == Form::binary_double) return each_binary_record<double>(file, block, reals, take);
    return each_text_record(file, block, reals, take);
}

/// For each node in VTK's order its position in the file: upright edges come before those of the top.
std::span<const std::uint8_t> node_order_of(std::uint8_t vtk_type) {
    static constexpr std::array<std::uint8_t, 20> hexahedron{0,  1,  2,  3,  4,  5,  6,  7,  8,  9,
                                                             10, 11, 16, 17, 18, 19, 12, 13, 14, 15};
    static constexpr std::array<std::uint8_t, 15> wedge{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 13, 14, 9, 10, 11};
    if (vtk_type == 25) return hexahedron;
    if (vtk_type == 26) return wedge;
    return {};
}

class FrdReader {
public:
    FrdReader(std::string_view file, frd::Index index) : file_(file), index_(std::move(index)) {}

    FileInfo info() const;
    Result<ReadResult> read(const ReadOptions& options, const Progress& progress);

private:
    Result<void> read_nodes(Grid& grid);
    Result<void> read_elements(Grid& grid);
    Result<void> read_text_elements(CellList& cells);
    Result<void> read_binary_elements(CellList& cells) const;
    Result<void> add_element(std::int64_t number, std::int64_t type, std::span<const std::int64_t> nodes,
                             CellList& cells) const;
    template <class Real>
    Result<std::vector<Field>> values_of(const frd::Values& values, const std::vector<NamedComponents>& fields) const;

    std::string_view file_;
    frd::Index index_;
    NumberMap nodes_;
    std::map<std::int64_t, std::uint64_t> unknown_; ///< elements of a type that is not known
};

ScalarType type_of(const frd::Values& values) {
    return values.block.form == Form::binary_double ? ScalarType::float64 : ScalarType::float32;
}

FileInfo FrdReader::info() const {
    FileInfo info;
    info.format = "frd";
    for (const frd::Step& step : index_.steps) info.times.push_back(step.value);
    std::set<std::string> readable, announced;
    for (const frd::Step& step : index_.steps)
        for (const frd::Values& values : step.values) {
            if (!values.problem.empty()) continue;
            readable.insert(values.name);
            for (const NamedComponents& field : values.fields)
                if (announced.insert(field.name).second)
                    announce(info, {field.name, Association::point, type_of(values), field.count});
        }
    for (const frd::Step& step : index_.steps)
        for (const frd::Values& values : step.values)
            if (!values.problem.empty())
                leave_out(info, {readable.contains(values.name) ? "point field of a step" : "point field", values.name,
                                 values.problem});
    if (index_.more_meshes > 0)
        leave_out(info, {"block", "nodes and elements", "the file has a mesh before it, which is read"});
    if (index_.unknown_lines > 0)
        leave_out(info, {"line", "between blocks",
                         fmt::format("{} begin no block that is known, the first at byte {}", index_.unknown_lines,
                                     index_.first_unknown)});
    if (index_.cut_at)
        leave_out(info, {"rest of the file", "values",
                         fmt::format("the block at byte {} announces more values than are left", *index_.cut_at)});
    return info;
}

Result<void> FrdReader::read_nodes(Grid& grid) {
    std::vector<double> points;
    points.reserve(static_cast<std::size_t>(std::min<std::uint64_t>(3 * index_.nodes.count, file_.size())));
    const auto done = each_record(file_, index_.nodes, 3, [&](std::int64_t number, auto place) -> Result<void> {
        nodes_.add(number);
        points.insert(points.end(), place.begin(), place.end());
        return {};
    });
    if (!done) return done;
    grid.points = Array::own(std::move(points), 3);
    return nodes_.close("node");
}

Result<void> FrdReader::add_element(std::int64_t number, std::int64_t type, std::span<const std::int64_t> nodes,
                                    CellList& cells) const {
    const frd::ElementType element = frd::element_type(type);
    if (nodes.size() != element.nodes)
        return invalid_data(fmt::format("element {} of type {} has {} nodes, but must have {}", number, type,
                                        nodes.size(), element.nodes));
    cells.start(element.vtk_type, element.nodes);
    const auto order = node_order_of(element.vtk_type);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const std::int64_t node = nodes[order.empty() ? i : order[i]];
        const std::uint64_t place = nodes_.find(node);
        if (place == NumberMap::none)
            return invalid_data(fmt::format("element {} has node {}, which is not there", number, node));
        cells.corner(place);
    }
    return {};
}

Result<void> FrdReader::read_text_elements(CellList& cells) {
    const Block& block = index_.elements;
    const std::size_t width = number_width(block);
    std::vector<std::int64_t> nodes;
    std::uint64_t records = 0;
    for (std::size_t at = block.begin; at < block.end; ++records) {
        std::string_view line = frd::take_line(file_, at);
        std::int64_t number = 0, type = 0;
        if (!line.starts_with(" -1") || !frd::number_at(line, key_width, width, number) ||
            !frd::number_at(line, key_width + width, 5, type))
            return wrong_at(at, fmt::format("an element begins with {}, not with -1, a number and a type",
                                            in_quotes(line.substr(0, 24))));
        nodes.clear();
        for (std::size_t next = at; next < block.end; at = next) {
            line = frd::take_line(file_, next);
            if (!line.starts_with(" -2")) break;
            std::int64_t node = 0;
            for (std::size_t column = key_width; frd::number_at(line, column, width, node); column += width)
                nodes.push_back(node);
        }
        if (frd::element_type(type).nodes == 0) ++unknown_[type];
        else if (auto added = add_element(number, type, nodes, cells); !added) return added;
    }
    if (records == block.count) return {};
    return wrong_at(block.end, fmt::format("there are {} elements, but {} are announced", records, block.count));
}

Result<void> FrdReader::read_binary_elements(CellList& cells) const {
    std::size_t at = index_.elements.begin;
    std::vector<std::int64_t> nodes;
    for (std::uint64_t i = 0; i < index_.elements.count; ++i) {
        const std::int64_t number = stored<std::int32_t>(file_, at), type = stored<std::int32_t>(file_, at + 4);
        at += 16;
        nodes.resize(frd::element_type(type).nodes);
        for (std::int64_t& node : nodes) {
            node = stored<std::int32_t>(file_, at);
            at += 4;
        }
        if (auto added = add_element(number, type, nodes, cells); !added) return added;
    }
    return {};
}

Result<void> FrdReader::read_elements(Grid& grid) {
    CellList cells(nodes_.size());
    const auto done = is_binary(index_.elements.form) ? read_binary_elements(cells) : read_text_elements(cells);
    if (!done) return done;
    grid.cells = cells.finish();
    return {};
}

template <class Real>
Result<std::vector<Field>> FrdReader::values_of(const frd::Values& values,
                                                const std::vector<NamedComponents>& fields) const {
    const auto points = static_cast<std::size_t>(nodes_.size());
    std::vector<std::vector<Real>> all;
    for (const NamedComponents& field : fields)
        all.emplace_back(points * field.count, std::numeric_limits<Real>::quiet_NaN());
    const auto take = [&](std::int64_t number, auto reals) -> Result<void> {
        const std::uint64_t place = nodes_.find(number);
        if (place == NumberMap::none) return invalid_data(fmt::format("node {} is not there", number));
        for (std::size_t f = 0; f < fields.size(); ++f)
            for (std::size_t i = 0; i < fields[f].count; ++i)
                all[f][static_cast<std::size_t>(place) * fields[f].count + i] =
                    static_cast<Real>(reals[fields[f].first + i]);
        return {};
    };
    if (const auto done = each_record(file_, values.block, values.components.size(), take); !done) return done.error();
    std::vector<Field> made;
    for (std::size_t f = 0; f < fields.size(); ++f)
        made.push_back({fields[f].name, Array::own(std::move(all[f]), fields[f].count)});
    return made;
}

Result<ReadResult> FrdReader::read(const ReadOptions& options, const Progress& progress) {
    ReadResult result;
    result.info = info();
    const auto step = choose_step(result.info, options);
    if (!step) return step.error();
    result.step = *step;
    if (!index_.has_nodes || !index_.has_elements)
        return invalid_data(fmt::format("it has no block of {} ({})", index_.has_nodes ? "elements" : "nodes",
                                        index_.has_nodes ? "3C" : "2C"));
    if (auto read = read_nodes(result.grid); !read) return read.error();
    progress("read", 0.3);
    if (progress.cancelled()) return Pace::cancelled();
    if (auto read = read_elements(result.grid); !read) return read.error();
    progress("read", 0.5);
    if (progress.cancelled()) return Pace::cancelled();
    for (const auto& [type, count] : unknown_)
        result.notes.push_back(fmt::format("{} elements of type {} are left out: this type is not known", count, type));
    if (index_.steps.empty()) return result;
    for (const frd::Values& values : index_.steps[*step].values) {
        std::vector<NamedComponents> fields = values.fields;
        std::erase_if(fields,
                      [&](const NamedComponents& field) { return !wanted(options, Association::point, field.name); });
        if (!values.problem.empty() || fields.empty()) continue;
        auto read = type_of(values) == ScalarType::float64 ? values_of<double>(values, fields)
                                                           : values_of<float>(values, fields);
        if (read) std::ranges::move(*read, std::back_inserter(result.grid.point_fields));
        else
            for (const NamedComponents& field : fields)
                leave_out(result.info, {"point field", field.name, read.error().message});
    }
    return result;
}

} // namespace

bool looks_like_frd(std::string_view head) {
    const std::string_view line = head.substr(0, head.find('\n'));
    if (!line.starts_with("    1C") && !line.starts_with("    1U")) return false;
    return head.find("\n    2C") != std::string_view::npos || head.find("\n    1U") != std::string_view::npos ||
           head.find("\n    1P") != std::string_view::npos;
}

Result<FileInfo> inspect_frd(std::string_view file, const Progress&) {
    auto index = frd::index_of(file);
    if (!index) return index.error();
    return FrdReader(file, *std::move(index)).info();
}

Result<ReadResult> parse_frd(std::string_view file, const ReadOptions& options, const Progress& progress) {
    auto index = frd::index_of(file);
    if (!index) return index.error();
    return FrdReader(file, *std::move(index)).read(options, progress);
}

} // namespace isotet::io
