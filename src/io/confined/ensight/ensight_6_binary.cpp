// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// EnSight 6 as C binary: lines of 80 bytes, integers and floats of 4.
#include <array>

#include <fmt/core.h>

#include "io/confined/ensight/ensight_6.hpp"
#include "io/confined/ensight/ensight_walk.hpp"
#include "io/files/text_scanner.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t binary_line_bytes = 80;

/// Every node of an element is looked at where nodes have numbers of their own, which VTK's reader takes as they are.
void walk_binary_connectivity(EnsightFile& file, std::string_view type, std::uint64_t count,
                              const NodeNumbers& numbers) {
    constexpr const char* what = "the connectivity";
    constexpr std::uint64_t fourth = 3;
    const std::uint64_t nodes = nodes_of_element(type);
    if (!numbers.are_given()) return file.skip_integers(count, nodes, what);
    if (count > file.left() / 4 / nodes) file.missing(what, count);
    for (std::uint64_t i = 0; i < count * nodes; ++i) {
        const auto number = static_cast<std::int64_t>(file.count(what));
        numbers.expect(file, number);
        if (type.starts_with("tetra") && i % nodes == fourth && numbers.place(number) != number)
            file.wrong(
                fmt::format("VTK's reader takes number {} of a tetrahedron's fourth node for its place, which is {}",
                            number, numbers.place(number)));
    }
}

void walk_binary_elements(EnsightFile& file, EnsightPart& part, const NodeNumbers& numbers, bool ids) {
    while (!is_at_part(file)) {
        const std::string type(file.line("a type of elements"));
        if (nodes_of_element(type) == 0 || type.starts_with("g_"))
            file.wrong(fmt::format("{} is no type of elements", in_quotes(type)));
        const std::uint64_t count = file.count_of_unknown_order("the number of elements");
        part.elements[type] += count;
        part.cells += count;
        if (ids) file.skip_integers(count, 1, "the list of elements");
        walk_binary_connectivity(file, type, count, numbers);
    }
}

void walk_binary_block(EnsightFile& file, EnsightPart& part, std::string_view kind) {
    std::array<std::uint64_t, 3> size{};
    for (std::uint64_t& along : size) along = file.count_of_unknown_order("the size of a block");
    set_block_size(file, part, size, file.left());
    file.skip_floats(3 * part.nodes, "the coordinates of a block");
    const auto words = words_of(kind);
    if (words.size() > 1 && words[1] == "iblanked") file.skip_integers(part.nodes, 1, "the blanking of a block");
}

void walk_binary_values_of_block(EnsightFile& file, const EnsightCase::Variable& variable, const EnsightPart& part) {
    if (file.line("block") != "block") file.missing("block", 1);
    if (variable.components > 1) file.wrong("VTK's reader mixes up vectors and tensors of blocks");
    file.skip_floats(variable.of_nodes ? part.nodes : part.cells, "the values of a block");
}

void walk_binary_values_of_nodes(EnsightFile& file, const EnsightCase::Variable& variable, const EnsightGrid& grid,
                                 bool asked_for) {
    if (file.left() < binary_line_bytes)
        file.wrong(fmt::format("VTK's reader takes no fewer than {} bytes of values, or they are cut short",
                               binary_line_bytes));
    bool only_blocks = true;
    if (!is_at_part(file)) {
        file.skip_floats(grid.nodes * variable.components, "the values of nodes");
        only_blocks = false;
    }
    while (file.has_more()) {
        const std::uint64_t number = number_in_part_line(file, file.line("a part"));
        const EnsightPart& part = grid.part(file, number);
        if (!part.is_structured) file.wrong(fmt::format("part {} is no block, and has no nodes of its own", number));
        if (!only_blocks && asked_for)
            file.wrong("VTK's reader does not read the values of blocks behind those of nodes");
        walk_binary_values_of_block(file, variable, part);
    }
}

void walk_binary_values_of_elements(EnsightFile& file, const EnsightCase::Variable& variable, const EnsightGrid& grid) {
    while (file.has_more()) {
        const std::uint64_t number = number_in_part_line(file, file.line("a part"));
        const EnsightPart& part = grid.part(file, number);
        if (part.is_structured) {
            walk_binary_values_of_block(file, variable, part);
            continue;
        }
        EnsightBlocks blocks(file, part, number);
        while (!is_at_part(file)) {
            const std::uint64_t count = blocks.take(file.line("a type of elements"));
            file.skip_floats(count * variable.components, "the values of elements");
        }
        blocks.expect_all();
    }
}

} // namespace

EnsightGrid walk_6_binary_geometry(EnsightFile& file, bool in_step) {
    if (!in_step) file.line("its form");
    if (file.line("its description").starts_with("BEGIN TIME STEP"))
        file.wrong("it has time steps, but the case has no FILE section");
    file.line("its description");
    NodeNumbers numbers(file.line("\"node id\""));
    const bool ids = NodeNumbers(file.line("\"element id\"")).are_listed();
    if (!file.line("coordinates").starts_with("coordinates")) file.missing("coordinates", 1);
    EnsightGrid grid;
    grid.nodes = file.count_of_unknown_order("the number of nodes");
    std::vector<std::int64_t> given;
    if (numbers.are_given())
        for (const std::uint32_t number : file.counts(grid.nodes, "the list of nodes")) given.push_back(number);
    else if (numbers.are_listed()) file.skip_integers(grid.nodes, 1, "the list of nodes");
    numbers.set(file, given, grid.nodes);
    file.skip_floats(3 * grid.nodes, "the coordinates");
    while (file.has_more()) {
        EnsightPart& part = grid.add(file, number_in_part_line(file, file.line("a part")));
        file.line("the description of a part");
        const std::string kind(file.peek("the elements of a part"));
        if (!kind.starts_with("block")) {
            walk_binary_elements(file, part, numbers, ids);
            continue;
        }
        file.line("block");
        walk_binary_block(file, part, kind);
    }
    if (grid.parts.empty()) file.missing("a part", 1);
    return grid;
}

void walk_6_binary_variable(EnsightFile& file, const EnsightCase::Variable& variable, const EnsightGrid& grid,
                            bool asked_for) {
    if (file.line("its description").starts_with("BEGIN TIME STEP"))
        file.wrong("it has time steps, but the case has no FILE section");
    if (!file.has_more()) file.missing("values", 1);
    if (variable.of_nodes) walk_binary_values_of_nodes(file, variable, grid, asked_for);
    else walk_binary_values_of_elements(file, variable, grid);
}

void expect_no_elements_behind(EnsightFile& file) {
    while (file.left() >= binary_line_bytes) {
        const std::string_view line = file.bytes().substr(file.position(), binary_line_bytes);
        file.seek(file.position() + binary_line_bytes);
        for (const char* begin : {"part", "point", "bar", "tria", "quad", "tetra", "pyramid", "hexa", "penta"})
            if (line.starts_with(begin))
                file.wrong("VTK's reader takes elements of the next time step for ones of this step");
    }
}

} // namespace isotet::io::confined
