// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// EnSight 6: one list of nodes for all unstructured parts. The values of a node or element stand side by side.
#include <utility>

#include <fmt/core.h>

#include "io/confined/ensight/ensight_grid.hpp"
#include "io/files/text_scanner.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t any_on_line = 0;

/// The third word of "node id given".
std::string id_of(std::string_view line) {
    const auto words = words_of(line);
    return words.size() < 3 ? std::string() : std::string(words[2]);
}

/// The number in "part 3".
std::uint64_t number_of_part(EnsightFile& file) {
    const std::string_view line = file.line("a part");
    const auto words = words_of(line);
    std::int32_t number = 0;
    if (words.size() < 2 || words[0] != "part" || !parse_number(words[1], number) || number < 1)
        file.wrong(
            fmt::format("{} stands where a part was expected: something is missing, or too much", in_quotes(line)));
    return static_cast<std::uint64_t>(number);
}

void read_6_nodes(EnsightFile& file, EnsightGrid& grid, const std::string& ids) {
    const bool listed = ids == "given" || ids == "ignore";
    grid.is_numbered = ids == "given";
    grid.nodes = file.count("the number of nodes");
    std::vector<std::int32_t> numbers;
    if (listed && file.is_binary()) numbers = file.counts(grid.nodes, any_on_line, "the list of nodes");
    grid.points = Array::own(file.is_binary() ? file.floats(3 * grid.nodes, any_on_line, "the coordinates")
                                              : file.text_nodes(grid.nodes, listed, numbers),
                             3);
    if (!grid.is_numbered) return;
    for (const std::int32_t number : numbers) grid.numbers.add(number);
    if (auto closed = grid.numbers.close("node"); !closed) file.wrong(closed.error().message);
}

/// The places of nodes, from 1; what is no number of a node would be left to be found as none.
void find_nodes(const EnsightFile& file, const EnsightGrid& grid, std::vector<std::int32_t>& nodes) {
    if (!grid.is_numbered) return;
    for (std::int32_t& node : nodes) {
        const std::uint64_t place = grid.numbers.find(node);
        if (place == NumberMap::none) file.wrong(fmt::format("an element has node {}, which is not there", node));
        node = static_cast<std::int32_t>(place) + 1;
    }
}

/// In text the number of an element stands in front of its nodes.
std::vector<std::int32_t> read_6_rows(EnsightFile& file, std::uint64_t count, std::uint32_t width, bool ids) {
    constexpr const char* what = "the connectivity";
    if (!ids || file.is_binary()) {
        if (ids) file.integers(count, any_on_line, "the list of elements");
        return file.integers(count * width, width, what);
    }
    auto rows = file.integers(count * (width + 1), width + 1, what);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (i % (width + 1) != 0) rows[kept++] = rows[i];
    rows.resize(kept);
    return rows;
}

void read_6_elements(EnsightFile& file, const EnsightGrid& grid, EnsightPart& part, bool ids) {
    while (!is_at_part(file)) {
        const std::string type(file.line("a type of elements"));
        const EnsightElement* const element = ensight_element(type);
        if (!element || element->nodes == 0) file.wrong(fmt::format("{} is no type of elements", in_quotes(type)));
        const std::uint64_t count = file.count("the number of elements");
        if (count > file.left()) file.missing("the connectivity", count);
        part.elements[type].push_back({part.cells, count});
        part.cells += count;
        auto nodes = read_6_rows(file, count, element->nodes, ids);
        find_nodes(file, grid, nodes);
        part.made.add(*element, std::move(nodes));
    }
}

void read_block_values(EnsightFile& file, const EnsightPart& part, std::size_t place, EnsightField& field) {
    if (file.line("block") != "block") file.missing("block", 1);
    const std::uint64_t all = field.variable.of_nodes ? part.nodes : part.cells;
    field.put(place, all, {{0, all}},
              file.columns(all, field.variable.components, any_on_line, "the values of a block"));
}

void read_element_values(EnsightFile& file, const EnsightPart& part, std::size_t place, EnsightField& field) {
    EnsightBlocks blocks(file, part);
    while (!is_at_part(file)) {
        const auto& runs = blocks.take(file.line("a type of elements"));
        field.put(place, part.cells, runs,
                  file.floats(count_of(runs) * field.variable.components, any_on_line, "the values of elements"));
    }
    blocks.expect_all();
}

} // namespace

void read_6_geometry(EnsightFile& file, EnsightGrid& grid, bool in_step) {
    if (file.is_binary() && !in_step) file.line("its form");
    if (file.raw_line("its description").starts_with("BEGIN TIME STEP"))
        file.wrong("it has time steps, but the case has no FILE section");
    file.raw_line("its description");
    const std::string node_ids = id_of(file.raw_line("\"node id\"")), element_ids = id_of(file.line("\"element id\""));
    if (!file.line("coordinates").starts_with("coordinates")) file.missing("coordinates", 1);
    read_6_nodes(file, grid, node_ids);
    while (file.has_more()) {
        const std::uint64_t number = number_of_part(file);
        EnsightPart& part = grid.add(file, number, std::string(file.raw_line("the description of a part")));
        if (file.is_at("block")) read_block(file, part, std::string(file.line("block")), any_on_line);
        else read_6_elements(file, grid, part, element_ids == "given" || element_ids == "ignore");
    }
}

void read_6_values(EnsightFile& file, const EnsightGrid& grid, EnsightField& field) {
    if (!file.has_more()) file.missing("values", 1);
    const bool of_nodes = field.variable.of_nodes;
    if (of_nodes && !is_at_part(file))
        field.put(grid.parts.size(), grid.nodes, {{0, grid.nodes}},
                  file.floats(grid.nodes * field.variable.components, any_on_line, "the values of nodes"));
    while (file.has_more()) {
        const std::uint64_t number = number_of_part(file);
        const std::size_t place = grid.find(file, number);
        const EnsightPart& part = grid.parts[place];
        file.keep(part.is_wanted);
        if (part.is_structured) read_block_values(file, part, place, field);
        else if (of_nodes) file.wrong(fmt::format("part {} is no block, and has no nodes of its own", number));
        else read_element_values(file, part, place, field);
    }
}

} // namespace isotet::io::confined
