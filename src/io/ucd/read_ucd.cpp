// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
//   points cells point_values cell_values model_values
//   number x y z                              for each point
//   number material type point...             for each cell
//   arrays components...                      then "name, unit" for each array, then number value... for each point
//   the same for cells
#include "io/ucd/read_ucd.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/escape.hpp"
#include "io/files/pace.hpp"
#include "io/files/text_scanner.hpp"
#include "io/pieces/loaded.hpp"
#include "io/pieces/number_map.hpp"
#include "io/reader.hpp"
#include "io/ucd/read_binary_ucd.hpp"
#include "io/ucd/ucd_elements.hpp"

namespace isotet::io {
namespace {

using ucd::Element;
using ucd::elements;

struct Counts {
    std::uint64_t points = 0, cells = 0, point_values = 0, cell_values = 0, model_values = 0;
};

class UcdReader {
public:
    UcdReader(std::string_view text, const ReadOptions& options, const Progress& progress, Depth depth)
        : scanner_(text, '#'), options_(options), pace_(progress, text.size()), depth_(depth) {}

    Result<ReadResult> run() {
        result_.info.format = "ucd";
        if (!header() || !points() || !cells()) return *problem_;
        if (counts_.point_values > 0 && !values(Association::point, counts_.points, counts_.point_values))
            return *problem_;
        if (counts_.cell_values > 0 && !values(Association::cell, counts_.cells, counts_.cell_values)) return *problem_;
        if (auto step = choose_step(result_.info, options_); !step) return step.error();
        return std::move(result_);
    }

private:
    bool fail(std::string_view what) {
        if (!problem_) problem_ = invalid_data(fmt::format("{} at {}", what, scanner_.where()));
        return false;
    }
    bool goes_on() {
        if (pace_.goes_on(scanner_.position())) return true;
        problem_ = Pace::cancelled();
        return false;
    }
    template <class Number>
    bool next(Number& value, std::string_view what) {
        return scanner_.number(value) || fail(fmt::format("{} expected", what));
    }
    /// Every item takes some bytes: a count beyond what is left is wrong, and nothing is allocated for it.
    bool plausible(std::uint64_t count, std::string_view what, std::size_t bytes = 1) {
        return count <= (scanner_.left() + 1) / bytes ||
               fail(fmt::format("{} {} announced, but the file is shorter", count, what));
    }
    bool header() {
        return next(counts_.points, "number of points") && next(counts_.cells, "number of cells") &&
               next(counts_.point_values, "number of point values") &&
               next(counts_.cell_values, "number of cell values") &&
               next(counts_.model_values, "number of model values") &&
               plausible(counts_.points, "points", sizeof "1 0 0 0") &&
               plausible(counts_.cells, "cells", sizeof "1 1 pt 1");
    }
    bool points() {
        std::vector<double> places(3 * counts_.points);
        for (std::uint64_t i = 0; i < counts_.points; ++i) {
            std::int64_t number = 0;
            if (!goes_on() || !next(number, "number of a point")) return false;
            numbers_.add(number);
            for (std::uint64_t axis = 0; axis < 3; ++axis)
                if (!next(places[3 * i + axis], "a coordinate")) return false;
        }
        if (auto closed = numbers_.close("point"); !closed) return fail(closed.error().message);
        grid().points = Array::own(std::move(places), 3);
        return true;
    }
    bool cells() {
        std::vector<std::int64_t> connectivity, offsets{0};
        std::vector<std::uint8_t> types;
        std::vector<std::int32_t> materials;
        types.reserve(counts_.cells);
        for (std::uint64_t i = 0; i < counts_.cells; ++i) {
            std::int64_t number = 0;
            std::int32_t material = 0;
            if (!goes_on() || !next(number, "number of a cell") || !next(material, "material of a cell")) return false;
            cell_numbers_.add(number);
            const std::string_view name = scanner_.word();
            const Element* element = nullptr;
            for (const Element& known : elements)
                if (known.name == name) element = &known;
            if (!element)
                return fail(fmt::format("cell type {} is not one of pt, line, tri, quad, tet, pyr, prism, hex",
                                        in_quotes(name)));
            if (!corners(*element, connectivity)) return false;
            offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
            types.push_back(element->type);
            materials.push_back(material);
        }
        cells_are_numbered_ = static_cast<bool>(cell_numbers_.close("cell"));
        grid().cells.connectivity = Array::own(std::move(connectivity));
        grid().cells.offsets = Array::own(std::move(offsets));
        grid().cells.types = Array::own(std::move(types));
        keep("Material Id", Association::cell, Array::own(std::move(materials)));
        return true;
    }
    bool corners(const Element& element, std::vector<std::int64_t>& connectivity) {
        std::array<std::int64_t, 8> read{};
        for (int c = 0; c < element.corners; ++c) {
            std::int64_t number = 0;
            if (!next(number, "number of a corner")) return false;
            const std::uint64_t point = numbers_.find(number);
            if (point == NumberMap::none)
                return fail(fmt::format("a cell has point {}, which the file does not have,", number));
            read[static_cast<std::size_t>(c)] = static_cast<std::int64_t>(point);
        }
        for (int c = 0; c < element.corners; ++c)
            connectivity.push_back(read[static_cast<std::size_t>(element.order[static_cast<std::size_t>(c)])]);
        return true;
    }

    struct Column {
        std::string name;
        std::uint64_t components;
        bool wanted;
        std::vector<double> values;
    };

    bool values(Association association, std::uint64_t tuples, std::uint64_t stated) {
        std::vector<Column> columns;
        if (!value_header(association, stated, columns)) return false;
        if (!plausible(tuples * std::min<std::uint64_t>(stated, 1 << 20), "values", sizeof "0")) return false;
        for (Column& column : columns)
            if (column.wanted) column.values.resize(tuples * column.components);
        for (std::uint64_t i = 0; i < tuples; ++i) {
            std::int64_t number = 0;
            if (!goes_on() || !next(number, "number of a line of values")) return false;
            std::uint64_t tuple = i;
            if (!place(association, number, tuple)) return false;
            for (Column& column : columns)
                for (std::uint64_t c = 0; c < column.components; ++c) {
                    double value = 0;
                    if (!next(value, "a value")) return false;
                    if (column.wanted) column.values[tuple * column.components + c] = value;
                }
        }
        for (Column& column : columns) {
            if (column.name.empty()) continue;
            if (column.wanted) keep(column.name, association, Array::own(std::move(column.values), column.components));
            else announce(result_.info, {column.name, association, ScalarType::float64, column.components});
        }
        return true;
    }
    /// Some programs number the lines of cell values without regard to the numbers of the cells: then their order counts.
    bool place(Association association, std::int64_t number, std::uint64_t& tuple) {
        const bool point = association == Association::point;
        if (!point && !cells_are_numbered_) return true;
        const std::uint64_t found = point ? numbers_.find(number) : cell_numbers_.find(number);
        if (found == NumberMap::none && !point && tuple == 0) {
            cells_are_numbered_ = false;
            return true;
        }
        if (found == NumberMap::none)
            return fail(
                fmt::format("values for {} {}, which the file does not have,", point ? "point" : "cell", number));
        tuple = found;
        return true;
    }
    bool value_header(Association association, std::uint64_t stated, std::vector<Column>& columns) {
        std::uint64_t arrays = 0, sum = 0;
        if (!next(arrays, "number of arrays") || !plausible(arrays, "arrays")) return false;
        std::vector<std::uint64_t> components(arrays);
        for (std::uint64_t& count : components) {
            if (!next(count, "components of an array")) return false;
            if (count < 1 || count > 1000) return fail(fmt::format("an array of {} components", count));
            sum += count;
        }
        if (sum != stated) return fail(fmt::format("arrays of {} values, but {} are announced,", sum, stated));
        for (const std::uint64_t count : components) {
            std::string_view name = scanner_.line();
            name = name.substr(0, name.find(','));
            while (!name.empty() && is_space(name.back())) name.remove_suffix(1);
            if (scanner_.left() == 0) return fail("name of an array expected");
            if (!name.empty() && !columns.empty() && columns.back().name == name) { // as deal.II writes vectors
                columns.back().components += count;
                continue;
            }
            const std::string kind = association == Association::point ? "point field" : "cell field";
            const bool repeated = std::ranges::find(columns, name, &Column::name) != columns.end();
            if (name.empty()) leave_out(result_.info, {kind, "", "it has no name"});
            else if (repeated) leave_out(result_.info, {kind, std::string(name), "an earlier one has the same name"});
            const bool is_read = !name.empty() && !repeated;
            columns.push_back(
                {is_read ? std::string(name) : std::string(), count, is_read && is_wanted(association, name), {}});
        }
        return true;
    }
    void keep(std::string name, Association association, Array values) {
        announce(result_.info, {name, association, values.type(), values.components()});
        if (!is_wanted(association, name)) return;
        auto& fields = association == Association::point ? grid().point_fields : grid().cell_fields;
        fields.push_back({std::move(name), std::move(values)});
    }
    bool is_wanted(Association association, std::string_view name) const {
        return depth_ == Depth::arrays && wanted(options_, association, name);
    }
    Grid& grid() { return result_.grid; }

    TextScanner scanner_;
    const ReadOptions& options_;
    Pace pace_;
    Depth depth_;
    ReadResult result_;
    Counts counts_;
    NumberMap numbers_, cell_numbers_;
    bool cells_are_numbered_ = false;
    std::optional<Error> problem_;
};

} // namespace

bool looks_like_ucd(std::string_view head) {
    if (head.starts_with(ucd::binary_mark)) return true;
    TextScanner scanner(head, '#');
    std::uint64_t number = 0;
    if (scanner.at_end()) return false;
    int numbers = 0;
    while (!scanner.at_line_end() && scanner.number_of_line(number)) ++numbers;
    return numbers == 5 && scanner.at_line_end();
}

Result<FileInfo> inspect_ucd(std::string_view text, const Progress& progress) {
    auto result = text.starts_with(ucd::binary_mark) ? ucd::read_binary(text, {}, progress, Depth::description)
                                                     : UcdReader(text, {}, progress, Depth::description).run();
    if (!result) return result.error();
    return std::move(result->info);
}

Result<ReadResult> parse_ucd(std::string_view text, const ReadOptions& options, const Progress& progress) {
    if (text.starts_with(ucd::binary_mark)) return ucd::read_binary(text, options, progress, Depth::arrays);
    return UcdReader(text, options, progress, Depth::arrays).run();
}

} // namespace isotet::io
