// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// EnSight Gold: parts with nodes of their own.
#include <algorithm>
#include <cstring>

#include <fmt/core.h>

#include "io/confined/ensight/ensight_walk.hpp"
#include "io/files/text_scanner.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t gold_integer_width = 10;
constexpr std::uint64_t most_implied_nodes = (std::uint64_t{1} << 31) - 1; // VTK's reader counts them in an int

/// Numbers of nodes and elements are there when the file says so.
bool gold_has_ids(std::string_view line) {
    const auto words = words_of(line);
    return words.size() >= 3 && (words[2].starts_with("given") || words[2].starts_with("ignore"));
}

std::uint64_t gold_sum_of(const EnsightFile& file, const std::vector<std::uint32_t>& counts) {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : counts) {
        if (count > file.left()) file.wrong(fmt::format("an element has {} nodes or faces", count));
        sum += count;
    }
    return sum;
}

/// Elements that have so many corners each, or faces.
void skip_gold_rows(EnsightFile& file, const std::vector<std::uint32_t>& sizes) {
    constexpr const char* what = "the connectivity";
    if (file.is_binary()) file.skip_integers(1, gold_sum_of(file, sizes), what);
    else file.skip_lines(sizes, what);
}

void walk_gold_elements(EnsightFile& file, EnsightPart& part, bool ids) {
    while (file.has_more()) {
        const std::string type(file.peek("a part"));
        if (type.starts_with("part")) return;
        file.line("a type of elements");
        const bool sided = type == "nsided" || type == "g_nsided", faced = type == "nfaced" || type == "g_nfaced";
        const std::uint64_t nodes = nodes_of_element(type);
        if (nodes == 0 && !sided && !faced) file.wrong(fmt::format("{} is no type of elements", in_quotes(type)));
        const std::uint64_t count = file.count("the number of elements");
        part.elements[type] += count;
        part.cells += type.starts_with("g_") ? 0 : count;
        if (ids) file.skip_integers(count, 1, "the list of elements");
        if (count > file.left()) file.missing("the connectivity", count);
        if (sided) {
            skip_gold_rows(file, file.counts(count, "the corners of polygons"));
        } else if (faced) {
            const std::uint64_t faces = gold_sum_of(file, file.counts(count, "the faces of polyhedra"));
            skip_gold_rows(file, file.counts(faces, "the corners of faces"));
        } else {
            file.skip_integers(count, nodes, "the connectivity");
        }
    }
}

void walk_gold_block(EnsightFile& file, EnsightPart& part, std::string_view kind) {
    const bool rectilinear = kind.find("rectilinear") != std::string_view::npos;
    const bool uniform = kind.find("uniform") != std::string_view::npos;
    const auto sizes = file.counts(3, "the size of a block", EnsightFile::Lines::all_on_one);
    set_block_size(file, part, {sizes[0], sizes[1], sizes[2]},
                   rectilinear || uniform ? most_implied_nodes : file.left());
    if (uniform) {
        file.skip_floats(3, "the origin of a block");
        file.skip_floats(3, "the spacing of a block");
    } else if (rectilinear) {
        for (const std::uint64_t along : sizes) file.skip_floats(along, "the coordinates of a block");
    } else {
        for (int axis = 0; axis < 3; ++axis) file.skip_floats(part.nodes, "the coordinates of a block");
    }
    if (kind.find("iblanked") != std::string_view::npos) file.skip_integers(part.nodes, 1, "the blanking of a block");
    if (kind.find("with_ghost") == std::string_view::npos) return;
    file.line("ghost flags");
    file.skip_integers(part.cells, 1, "the ghost flags of a block");
    if (file.has_more()) file.wrong("VTK's reader does not read the parts behind ghost flags");
}

enum class Values : std::uint8_t { all, undefined, partial };

/// "coordinates undef", "hexa8 partial"; behind it the kind alone is left.
Values values_of(const EnsightFile& file, std::string& kind) {
    const auto words = words_of(kind);
    if (words.size() < 2) return Values::all;
    const bool undefined = words[1] == "undef", partial = words[1] == "partial";
    const bool as_read = kind == fmt::format("{} {}", words[0], words[1]); // by VTK's reader of binary files
    if (undefined || partial ? file.is_binary() && !as_read : !file.is_binary())
        file.wrong(fmt::format("{} stands where a kind of values was expected", in_quotes(kind)));
    kind = std::string(words[0]);
    if (!undefined && !partial) return Values::all;
    return undefined ? Values::undefined : Values::partial;
}

/// VTK's reader of text does not know which values are undefined, nor where parts of them belong.
void walk_undefined_text(EnsightFile& file, const EnsightCase::Variable& variable, Values values, bool is_block,
                         std::uint64_t count) {
    if (values == Values::partial) file.wrong("VTK's reader mixes up partial values in text");
    if (variable.components > 1 || (is_block && !variable.of_nodes))
        file.wrong("VTK's reader takes the undefined value in text for the first one");
    float undefined = 0;
    file.floats(1, "the undefined value", [&](double value) { undefined = static_cast<float>(value); });
    file.floats(count, "the values of a part", [&](double value) {
        if (static_cast<float>(value) == undefined)
            file.wrong("a value is undefined, which VTK's reader takes for a number in text");
    });
}

void walk_gold_values(EnsightFile& file, const EnsightCase::Variable& variable, Values values, bool is_block,
                      std::uint64_t count) {
    if (values != Values::all && !file.is_binary()) return walk_undefined_text(file, variable, values, is_block, count);
    if (values == Values::undefined) file.skip_floats(1, "the undefined value");
    if (values == Values::partial) {
        const std::uint64_t defined = file.count("the number of values");
        for (const std::uint64_t place : file.counts(defined, "the list of values"))
            if (place == 0 || place > count)
                file.wrong(fmt::format("value {} is given, but there are {} nodes or elements", place, count));
        count = defined;
    }
    for (std::size_t c = 0; c < variable.components; ++c) file.skip_floats(count, "the values of a part");
}

/// A part without nodes or elements may have a line that says what it has none of. VTK's reader of text ends there.
void walk_empty_part(EnsightFile& file) {
    if (is_at_part(file)) return;
    file.line("the kind of values of a part");
    if (!is_at_part(file)) file.wrong("a part has values, but no nodes or elements");
    if (!file.is_binary() && file.has_more())
        file.wrong("VTK's reader does not read the parts behind one without nodes or elements");
}

void walk_gold_part(EnsightFile& file, const EnsightCase::Variable& variable, const EnsightPart& part,
                    std::uint64_t number, bool asked_for) {
    const std::uint64_t all = variable.of_nodes ? part.nodes : part.cells;
    if (all == 0) return walk_empty_part(file);
    EnsightBlocks blocks(file, part, number);
    do {
        std::string kind(file.line("the kind of values of a part"));
        const Values values = values_of(file, kind);
        if (values != Values::all && !asked_for)
            file.wrong("VTK's reader loses its way where a step before the one to be read has undefined values");
        if (variable.of_nodes || part.is_structured) {
            const char* expected = part.is_structured ? "block" : "coordinates";
            if (kind != expected) file.wrong(fmt::format("{} stands where {} was expected", in_quotes(kind), expected));
            return walk_gold_values(file, variable, values, part.is_structured, all);
        }
        walk_gold_values(file, variable, values, false, blocks.take(kind));
    } while (!is_at_part(file));
    blocks.expect_all();
}

} // namespace

EnsightGrid walk_gold_geometry(EnsightFile& file, bool in_step) {
    if (file.is_binary() && !in_step) file.line("its form");
    const std::string_view description = in_step ? file.raw_line("its description") : file.line("its description");
    if (description.starts_with("BEGIN TIME STEP")) file.wrong("it has time steps, but the case has no FILE section");
    file.raw_line("its description");
    const bool node_ids = gold_has_ids(file.line("\"node id\"")),
               element_ids = gold_has_ids(file.line("\"element id\""));
    EnsightGrid grid;
    if (file.has_more() && file.peek("a part").starts_with("extents")) {
        file.line("extents");
        if (file.is_binary()) file.skip_floats(6, "the extents");
        else
            for (int axis = 0; axis < 3; ++axis) file.line("the extents");
    }
    while (file.has_more()) {
        if (const auto line = file.line("a part"); !line.starts_with("part"))
            file.wrong(fmt::format("{} stands where a part was expected", in_quotes(line)));
        EnsightPart& part = grid.add(file, file.part_number());
        file.line("the description of a part");
        const std::string kind(file.line("the coordinates of a part"));
        if (kind.starts_with("block")) {
            walk_gold_block(file, part, kind);
            continue;
        }
        if (!kind.starts_with("coordinates"))
            file.wrong(fmt::format("{} stands where coordinates were expected", in_quotes(kind)));
        part.nodes = file.count("the number of nodes");
        if (node_ids) file.skip_integers(part.nodes, 1, "the list of nodes");
        for (int axis = 0; axis < 3; ++axis) file.skip_floats(part.nodes, "the coordinates");
        walk_gold_elements(file, part, element_ids);
    }
    if (grid.parts.empty()) file.missing("a part", 1);
    if (!in_step) expect_whole_last_line(file, gold_integer_width);
    return grid;
}

void walk_gold_variable(EnsightFile& file, const EnsightCase::Variable& variable, const EnsightGrid& grid,
                        bool asked_for) {
    if (file.line("its description").starts_with("BEGIN TIME STEP"))
        file.wrong("it has time steps, but the case has no FILE section");
    std::set<std::uint64_t> numbers;
    while (file.has_more()) {
        if (const auto line = file.line("a part"); !line.starts_with("part"))
            file.wrong(
                fmt::format("{} stands where a part was expected: values are missing, or too many", in_quotes(line)));
        const std::uint64_t number = file.part_number();
        if (!numbers.insert(number).second) file.wrong(fmt::format("part {} is there twice", number));
        walk_gold_part(file, variable, grid.part(file, number), number, asked_for);
    }
    if (numbers.empty()) file.missing("a part", 1);
}

void check_gold_index(EnsightFile& file, std::size_t step, const std::vector<std::size_t>& begins) {
    constexpr std::size_t line = 80, offset = 8;
    const std::string_view bytes = file.bytes();
    if (!file.is_binary() || bytes.size() < line + offset ||
        !bytes.substr(bytes.size() - line).starts_with("FILE_INDEX"))
        return;
    const auto offset_at = [&](std::size_t at) {
        std::uint64_t value = 0;
        std::memcpy(&value, bytes.data() + at, sizeof value);
        return file.order() == EnsightOrder::big ? __builtin_bswap64(value) : value;
    };
    const std::uint64_t index = offset_at(bytes.size() - line - offset);
    if (index > bytes.size() - line - offset) file.wrong(fmt::format("its index of steps begins at byte {}", index));
    file.seek(static_cast<std::size_t>(index));
    const std::uint64_t steps = file.count("the number of steps in its index");
    if (steps > file.left() / offset) file.missing("the index of steps", steps);
    if (steps == 0) return;
    const std::size_t nearest = std::min<std::size_t>(step, steps) - 1;
    const std::uint64_t found = offset_at(file.position() + nearest * offset);
    if (nearest >= begins.size() || found != begins[nearest])
        file.wrong(fmt::format("its index says that step {} begins at byte {}, which is wrong", nearest + 1, found));
}

} // namespace isotet::io::confined
