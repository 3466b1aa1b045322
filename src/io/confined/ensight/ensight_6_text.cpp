// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// EnSight 6 as text: one list of nodes for all unstructured parts, numbers in columns of 12 characters, 6 on a line.
#include <algorithm>
#include <charconv>
#include <limits>

#include <fmt/core.h>

#include "io/confined/ensight/ensight_6.hpp"
#include "io/confined/ensight/ensight_walk.hpp"
#include "io/files/text_scanner.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t text_column = 12, text_integer_width = 8, floats_on_line = 6;

std::string_view without_blanks(std::string_view line) {
    while (!line.empty() && is_space(line.front())) line.remove_prefix(1);
    return line;
}

/// A place in a line, which goes forward as C's scanf() does.
class Columns {
public:
    Columns(const EnsightFile& file, std::string_view line, const char* what) : file_(file), line_(line), what_(what) {}

    /// A number of at most so many characters, with space or a sign behind it. Returns where it begins.
    template <class Number>
    std::size_t number(std::size_t width, Number& value) {
        while (at_ < line_.size() && is_space(line_[at_])) ++at_;
        const std::size_t begin = at_;
        std::string_view word = line_.substr(at_, width);
        if (word.size() > 1 && word[0] == '+' && word[1] != '-') {
            word.remove_prefix(1);
            ++at_;
        }
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error == std::errc::invalid_argument || (std::is_integral_v<Number> && error != std::errc{})) refuse();
        at_ += static_cast<std::size_t>(end - word.data());
        if (at_ < line_.size() && !is_space(line_[at_]) && line_[at_] != '-' && line_[at_] != '+') refuse();
        return begin;
    }
    void end() {
        if (!without_blanks(line_.substr(at_)).empty()) refuse();
    }
    std::size_t position() const noexcept { return at_; }

    [[noreturn]] void refuse() const {
        file_.wrong(fmt::format("{} should stand in columns, but a line is {}: it is cut short or broken", what_,
                                in_quotes(line_)));
    }

private:
    const EnsightFile& file_;
    std::string_view line_;
    const char* what_;
    std::size_t at_ = 0;
};

/// `fixed`   VTK's reader takes the numbers from their columns, also where they do not stand there
void skip_text_float_line(EnsightFile& file, std::size_t count, bool fixed, const char* what) {
    Columns columns(file, file.line(what), what);
    float value = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t before = columns.position(), begin = columns.number(text_column, value);
        if (fixed && i > 0 && (before > i * text_column || begin < i * text_column)) columns.refuse();
    }
    columns.end();
}

/// Values without space for others behind them: 6 on each line, and fewer on the last one.
void skip_text_floats(EnsightFile& file, std::uint64_t count, const char* what) {
    if (count > file.left()) file.missing(what, count);
    for (std::uint64_t i = 0; i < count / floats_on_line; ++i) skip_text_float_line(file, floats_on_line, false, what);
    if (const auto rest = static_cast<std::size_t>(count % floats_on_line); rest > 0)
        skip_text_float_line(file, rest, true, what);
}

bool is_at_text_part(EnsightFile& file) {
    return !file.has_more() || without_blanks(file.peek("a part")).starts_with("part");
}

void walk_text_nodes(EnsightFile& file, std::uint64_t count, NodeNumbers& numbers) {
    constexpr const char* what = "the coordinates";
    if (count > file.left()) file.missing(what, count);
    std::vector<std::int64_t> given;
    for (std::uint64_t i = 0; i < count; ++i) {
        Columns columns(file, file.line(what), what);
        std::int32_t number = 0;
        float value = 0;
        if (numbers.are_listed()) columns.number(text_integer_width, number);
        for (int axis = 0; axis < 3; ++axis) columns.number(text_column, value);
        columns.end();
        if (numbers.are_given()) given.push_back(number);
    }
    numbers.set(file, given, count);
}

void walk_text_elements(EnsightFile& file, EnsightPart& part, const NodeNumbers& numbers, bool ids) {
    std::vector<std::int64_t> row;
    while (!is_at_text_part(file)) {
        const std::string type(without_blanks(file.line("a type of elements")));
        const std::uint64_t nodes = nodes_of_element(type);
        if (nodes == 0 || type.starts_with("g_")) file.wrong(fmt::format("{} is no type of elements", in_quotes(type)));
        const std::uint64_t count = file.count("the number of elements");
        if (count > file.left()) file.missing("the connectivity", count);
        part.elements[type] += count;
        part.cells += count;
        for (std::uint64_t i = 0; i < count; ++i) {
            if (!integers_of(file.line("the connectivity"), row) || row.size() != nodes + (ids ? 1 : 0))
                file.missing("the connectivity", count);
            for (std::size_t j = ids ? 1 : 0; j < row.size(); ++j) numbers.expect(file, row[j]);
        }
    }
}

/// VTK's reader blanks other points than those that are blanked behind the first line.
void walk_text_blanking(EnsightFile& file, std::uint64_t nodes) {
    constexpr std::uint64_t on_line = 10;
    std::vector<std::int64_t> row;
    for (std::uint64_t i = 0; i < nodes; i += on_line) {
        if (!integers_of(file.line("the blanking of a block"), row) || row.size() != std::min(on_line, nodes - i))
            file.missing("the blanking of a block", nodes);
        if (i > 0 && nodes / on_line != on_line && std::find(row.begin(), row.end(), 0) != row.end())
            file.wrong("VTK's reader mixes up the points that are blanked");
    }
}

void walk_text_block(EnsightFile& file, EnsightPart& part, std::string_view kind) {
    const auto sizes = file.counts(3, "the size of a block", EnsightFile::Lines::all_on_one);
    set_block_size(file, part, {sizes[0], sizes[1], sizes[2]}, file.left());
    for (int axis = 0; axis < 3; ++axis) skip_text_floats(file, part.nodes, "the coordinates of a block");
    const auto words = words_of(kind);
    if (words.size() > 1 && words[1] == "iblanked") walk_text_blanking(file, part.nodes);
}

void walk_text_values_of_blocks(EnsightFile& file, const EnsightCase::Variable& variable, const EnsightPart& part) {
    constexpr const char* what = "the values of a block";
    const std::uint64_t count = variable.of_nodes ? part.nodes : part.cells;
    if (file.line("block") != "block") file.missing("block", 1);
    if (variable.components > 3 || (variable.of_nodes && variable.components > 1))
        file.wrong("VTK's reader mixes up vectors and tensors of blocks");
    for (std::size_t c = 0; c < variable.components; ++c) skip_text_floats(file, count, what);
    const bool whole = count % floats_on_line == 0;
    if (file.has_more() && variable.components == 1 && variable.of_nodes == whole)
        file.wrong("VTK's reader does not read the parts behind this block");
}

void walk_text_values_of_nodes(EnsightFile& file, const EnsightCase::Variable& variable, const EnsightGrid& grid) {
    if (!is_at_text_part(file)) skip_text_floats(file, grid.nodes * variable.components, "the values of nodes");
    while (file.has_more()) {
        const std::uint64_t number = number_in_part_line(file, file.line("a part"));
        const EnsightPart& part = grid.part(file, number);
        if (!part.is_structured) file.wrong(fmt::format("part {} is no block, and has no nodes of its own", number));
        walk_text_values_of_blocks(file, variable, part);
    }
}

void walk_text_values_of_elements(EnsightFile& file, const EnsightCase::Variable& variable, const EnsightGrid& grid) {
    while (file.has_more()) {
        const std::string_view line = file.line("a part");
        if (!line.starts_with("part")) file.missing("a part", 1);
        const std::uint64_t number = number_in_part_line(file, line);
        const EnsightPart& part = grid.part(file, number);
        if (part.is_structured) {
            walk_text_values_of_blocks(file, variable, part);
            continue;
        }
        EnsightBlocks blocks(file, part, number);
        while (!is_at_text_part(file)) {
            const std::uint64_t count = blocks.take(file.line("a type of elements"));
            if (part.order + 1 != number)
                file.wrong(fmt::format("part {} is the {}. one of the geometry: VTK's reader confuses the values of "
                                       "elements unless parts are numbered from 1 on",
                                       number, part.order + 1));
            skip_text_floats(file, count * variable.components, "the values of elements");
        }
        blocks.expect_all();
    }
}

} // namespace

EnsightGrid walk_6_text_geometry(EnsightFile& file, bool in_step) {
    if (file.raw_line("its description").starts_with("BEGIN TIME STEP"))
        file.wrong("it has time steps, but the case has no FILE section");
    file.raw_line("its description");
    NodeNumbers numbers(file.raw_line("\"node id\""));
    const bool ids = NodeNumbers(file.line("\"element id\"")).are_listed();
    if (!without_blanks(file.line("coordinates")).starts_with("coordinates")) file.missing("coordinates", 1);
    EnsightGrid grid;
    grid.nodes = file.count("the number of nodes");
    walk_text_nodes(file, grid.nodes, numbers);
    while (file.has_more()) {
        EnsightPart& part = grid.add(file, number_in_part_line(file, file.line("a part")));
        file.raw_line("the description of a part");
        const std::string kind(without_blanks(file.peek("the elements of a part")));
        if (!kind.starts_with("block")) {
            walk_text_elements(file, part, numbers, ids);
            continue;
        }
        file.line("block");
        walk_text_block(file, part, kind);
    }
    if (grid.parts.empty()) file.missing("a part", 1);
    if (!in_step) expect_whole_last_line(file, text_integer_width);
    return grid;
}

void walk_6_text_variable(EnsightFile& file, const EnsightCase::Variable& variable, const EnsightGrid& grid) {
    if (file.raw_line("its description").starts_with("BEGIN TIME STEP"))
        file.wrong("it has time steps, but the case has no FILE section");
    if (!file.has_more()) file.missing("values", 1);
    if (variable.of_nodes) walk_text_values_of_nodes(file, variable, grid);
    else walk_text_values_of_elements(file, variable, grid);
}

} // namespace isotet::io::confined
