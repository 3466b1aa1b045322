// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// EnSight Gold: parts with nodes of their own; in text one value, or the nodes of one element, on a line.
#include <algorithm>
#include <limits>
#include <utility>

#include <fmt/core.h>

#include "io/confined/ensight/ensight_grid.hpp"
#include "io/files/escape.hpp"
#include "io/files/text_scanner.hpp"

namespace isotet::io::confined {
namespace {

/// Numbers of nodes and elements are there when the file says so. They name nothing.
bool gold_has_ids(std::string_view line) {
    const auto words = words_of(line);
    return words.size() >= 3 && (words[2].starts_with("given") || words[2].starts_with("ignore"));
}

/// Gives EnsightCells nothing of ghosts.
void read_gold_rows(EnsightFile& file, EnsightPart& part, const EnsightElement& element, std::uint64_t count,
                    bool ghost) {
    constexpr const char* what = "the connectivity";
    if (element.nodes > 0) {
        auto nodes = file.integers(count * element.nodes, element.nodes, what);
        if (!ghost) part.made.add(element, std::move(nodes));
        return;
    }
    const bool polyhedra = element.vtk_type == ensight_polyhedron;
    const auto sizes = file.counts(count, 1, polyhedra ? "the faces of polyhedra" : "the corners of polygons");
    const auto corners =
        polyhedra ? file.counts(file.sum_of(sizes), 1, "the corners of faces") : std::vector<std::int32_t>();
    auto nodes = file.rows(polyhedra ? corners : sizes, what);
    if (ghost || nodes.empty()) return;
    if (polyhedra) part.made.add_polyhedra(sizes, corners, nodes, part.nodes);
    else part.made.add_polygons(sizes, std::move(nodes));
}

void read_gold_elements(EnsightFile& file, EnsightPart& part, bool ids) {
    while (!is_at_part(file)) {
        const std::string type(file.line("a type of elements"));
        const bool ghost = type.starts_with("g_");
        const EnsightElement* const element = ensight_element(std::string_view(type).substr(ghost ? 2 : 0));
        if (!element) file.wrong(fmt::format("{} is no type of elements", in_quotes(type)));
        const std::uint64_t count = file.count("the number of elements");
        part.elements[type].push_back({part.cells, count});
        if (!ghost) part.cells += count;
        if (ids) file.integers(count, 1, "the list of elements");
        if (count > file.left()) file.missing("the connectivity", count);
        read_gold_rows(file, part, *element, count, ghost);
    }
}

/// Values that are undefined or not given are NaN.
std::vector<float> read_gold_values(EnsightFile& file, const std::string& kind, std::size_t components,
                                    std::uint64_t count) {
    constexpr const char* what = "the values of a part";
    constexpr float none = std::numeric_limits<float>::quiet_NaN();
    if (has_word(kind, "undef")) {
        const auto undefined = file.floats(1, 1, "the undefined value");
        auto values = file.columns(count, components, 1, what);
        if (!values.empty()) std::ranges::replace(values, undefined.front(), none);
        return values;
    }
    if (!has_word(kind, "partial")) return file.columns(count, components, 1, what);
    const auto places = file.counts(file.count("the number of values"), 1, "the list of values");
    for (const std::int32_t place : places)
        if (place == 0 || static_cast<std::uint64_t>(place) > count)
            file.wrong(fmt::format("value {} is given, but there are {} nodes or elements", place, count));
    const auto given = file.columns(places.size(), components, 1, what);
    std::vector<float> values(given.empty() && !places.empty() ? 0 : count * components, none);
    for (std::size_t i = 0; i < given.size(); ++i)
        values[(static_cast<std::size_t>(places[i / components]) - 1) * components + i % components] = given[i];
    return values;
}

/// A part without nodes or elements may have a line that says what it has none of.
bool is_without_values(EnsightFile& file, const EnsightPart& part, bool of_nodes) {
    const auto is_empty = [](const auto& element) { return count_of(element.second) == 0; };
    if (of_nodes || part.is_structured ? part.nodes > 0 : !std::ranges::all_of(part.elements, is_empty)) return false;
    if (is_at_part(file)) return true;
    file.line("the kind of values of a part");
    if (!is_at_part(file)) file.wrong(fmt::format("a part has values, but no nodes or elements in {}", escaped(part.file)));
    return true;
}

void read_gold_part(EnsightFile& file, const EnsightPart& part, std::size_t place, EnsightField& field) {
    const bool of_nodes = field.variable.of_nodes, is_whole = of_nodes || part.is_structured;
    const char* const expected = part.is_structured ? "block" : "coordinates";
    const std::uint64_t all = of_nodes ? part.nodes : part.cells;
    if (is_without_values(file, part, of_nodes)) return;
    EnsightBlocks blocks(file, part);
    while (!is_at_part(file)) {
        const std::string kind(file.line("the kind of values of a part"));
        const std::string name = kind.substr(0, kind.find(' '));
        if (is_whole && name != expected)
            file.wrong(fmt::format("{} stands where {} was expected", in_quotes(kind), expected));
        const std::vector<EnsightPart::Run> runs =
            is_whole ? std::vector<EnsightPart::Run>{{0, all}} : blocks.take(name);
        auto values = read_gold_values(file, kind, field.variable.components, count_of(runs));
        if (!name.starts_with("g_")) field.put(place, all, runs, std::move(values));
        if (is_whole) return;
    }
    if (is_whole) file.missing("the values of a part", all);
    blocks.expect_all();
}

void expect_part_line(EnsightFile& file) {
    if (const auto line = file.line("a part"); !line.starts_with("part"))
        file.wrong(
            fmt::format("{} stands where a part was expected: something is missing, or too much", in_quotes(line)));
}

} // namespace

void read_gold_geometry(EnsightFile& file, EnsightGrid& grid, bool in_step) {
    constexpr std::size_t extents = 6;
    if (file.is_binary() && !in_step) file.line("its form");
    const std::string_view description = in_step ? file.raw_line("its description") : file.line("its description");
    if (description.starts_with("BEGIN TIME STEP")) file.wrong("it has time steps, but the case has no FILE section");
    file.raw_line("its description");
    const bool node_ids = gold_has_ids(file.line("\"node id\"")),
               element_ids = gold_has_ids(file.line("\"element id\""));
    if (file.is_at("extents")) {
        file.line("extents");
        file.floats(extents, 0, "the extents");
    }
    while (file.has_more()) {
        expect_part_line(file);
        const std::uint64_t number = file.count("the number of a part");
        EnsightPart& part = grid.add(file, number, std::string(file.raw_line("the description of a part")));
        if (part.name.empty() && !file.is_at("coordinates") && !file.is_at("block"))
            part.name = file.line("the description of a part");
        if (is_at_part(file)) continue; // it is empty
        const std::string kind(file.line("the coordinates of a part"));
        if (kind.starts_with("block")) {
            read_block(file, part, kind, 1);
            continue;
        }
        if (!kind.starts_with("coordinates"))
            file.wrong(fmt::format("{} stands where coordinates were expected", in_quotes(kind)));
        part.nodes = file.count("the number of nodes");
        if (node_ids) file.integers(part.nodes, 1, "the list of nodes");
        part.points = Array::own(file.columns(part.nodes, 3, 1, "the coordinates"), 3);
        read_gold_elements(file, part, element_ids);
    }
}

void read_gold_values(EnsightFile& file, const EnsightGrid& grid, EnsightField& field) {
    std::set<std::uint64_t> numbers;
    while (file.has_more()) {
        expect_part_line(file);
        const std::uint64_t number = file.count("the number of a part");
        if (!numbers.insert(number).second) file.wrong(fmt::format("part {} is there twice", number));
        const std::size_t place = grid.find(file, number);
        file.keep(grid.parts[place].is_wanted);
        read_gold_part(file, grid.parts[place], place, field);
    }
    if (numbers.empty()) file.missing("a part", 1);
}

} // namespace isotet::io::confined
