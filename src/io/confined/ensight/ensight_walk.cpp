// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/ensight/ensight_walk.hpp"

#include <algorithm>

#include <fmt/core.h>

#include "io/files/text_scanner.hpp"

namespace isotet::io::confined {

EnsightPart& EnsightGrid::add(const EnsightFile& file, std::uint64_t number) {
    const std::size_t before = parts.size();
    const auto [at, is_new] = parts.try_emplace(number);
    if (!is_new) file.wrong(fmt::format("part {} is there twice", number));
    at->second.order = before;
    return at->second;
}

const EnsightPart& EnsightGrid::part(const EnsightFile& file, std::uint64_t number) const {
    const auto found = parts.find(number);
    if (found == parts.end()) file.wrong(fmt::format("the geometry has no part {}", number));
    return found->second;
}

bool EnsightGrid::ends_with_block() const {
    return std::any_of(parts.begin(), parts.end(), [&](const auto& part) {
        return part.second.is_structured && part.second.order + 1 == parts.size();
    });
}

bool is_at_part(EnsightFile& file) { return !file.has_more() || file.peek("a part").starts_with("part"); }

std::uint64_t number_in_part_line(const EnsightFile& file, std::string_view line) {
    const auto words = words_of(line);
    std::int32_t number = 0;
    if (words.size() < 2 || words[0] != "part" || !parse_number(words[1], number) || number < 1)
        file.wrong(
            fmt::format("{} stands where a part was expected: something is missing, or too much", in_quotes(line)));
    return static_cast<std::uint64_t>(number);
}

std::uint64_t nodes_of_element(std::string_view type) {
    if (type.starts_with("g_")) type.remove_prefix(2); // ghosts
    struct Element {
        std::string_view name;
        std::uint64_t nodes;
    };
    constexpr std::array elements{Element{"point", 1},    Element{"bar2", 2},       Element{"bar3", 3},
                                  Element{"tria3", 3},    Element{"tria6", 6},      Element{"quad4", 4},
                                  Element{"quad8", 8},    Element{"tetra4", 4},     Element{"tetra10", 10},
                                  Element{"pyramid5", 5}, Element{"pyramid13", 13}, Element{"penta6", 6},
                                  Element{"penta15", 15}, Element{"hexa8", 8},      Element{"hexa20", 20}};
    for (const Element& element : elements)
        if (element.name == type) return element.nodes;
    return 0;
}

void set_block_size(const EnsightFile& file, EnsightPart& part, const std::array<std::uint64_t, 3>& size,
                    std::uint64_t most_nodes) {
    part.is_structured = true;
    part.nodes = part.cells = 1;
    for (const std::uint64_t along : size) {
        if (along == 0 || part.nodes > most_nodes / along)
            file.wrong(fmt::format("a block has {} x {} x {} nodes", size[0], size[1], size[2]));
        part.nodes *= along;
        part.cells *= std::max<std::uint64_t>(along - 1, 1);
    }
}

std::uint64_t EnsightBlocks::take(std::string_view type) {
    const auto found = part_.elements.find(type);
    if (found == part_.elements.end()) file_.wrong(fmt::format("part {} has no elements {}", number_, in_quotes(type)));
    if (!taken_.emplace(type).second)
        file_.wrong(fmt::format("the values of \"{}\" of part {} are there twice", type, number_));
    return found->second;
}

void EnsightBlocks::expect_all() const {
    for (const auto& [type, count] : part_.elements)
        if (count > 0 && !type.starts_with("g_") && !taken_.contains(type))
            file_.wrong(
                fmt::format("part {} has {} elements \"{}\", but there are no values of them", number_, count, type));
}

std::vector<std::size_t> walk_steps(EnsightFile& file, std::size_t step, OtherSteps other_steps,
                                    const std::function<void(bool asked_for)>& walk) {
    constexpr std::string_view begin = "BEGIN TIME STEP", end = "END TIME STEP";
    constexpr std::size_t line_bytes = 80;
    std::vector<std::size_t> begins;
    file.expect_end_of_step();
    const auto find_begin = [&] {
        while (!file.at_end() && (!file.is_binary() || file.left() >= line_bytes))
            if (file.line("BEGIN TIME STEP").starts_with(begin)) return true;
        return false;
    };
    const auto skip_text = [&] {
        for (std::string_view line; !line.starts_with(end);) {
            line = file.line("END TIME STEP");
            if (line.starts_with(begin)) file.wrong("a time step begins in another one");
        }
    };
    while ((begins.size() < step || other_steps != OtherSteps::before) && find_begin()) {
        begins.push_back(file.position());
        const bool asked_for = begins.size() == step;
        if (!file.is_binary() && !asked_for) {
            skip_text();
            continue;
        }
        walk(asked_for);
        if (!file.line("END TIME STEP").starts_with(end)) file.missing("END TIME STEP", 1);
    }
    if (begins.size() < step && (other_steps != OtherSteps::all_or_only_one || begins.size() != 1))
        file.wrong(fmt::format("step {} is to be read, but there are {} between BEGIN TIME STEP and END TIME STEP",
                               step, begins.size()));
    return begins;
}

void expect_whole_last_line(const EnsightFile& file, std::size_t integer_width) {
    constexpr std::size_t float_width = 12;
    const std::string_view text = file.bytes();
    if (file.is_binary() || text.empty() || is_space(text.back())) return;
    const std::string_view line = text.substr(text.find_last_of('\n') + 1);
    const std::string_view word = line.substr(line.find_last_of(" \t") + 1);
    const std::size_t width = word.find_first_of(".eE") == std::string_view::npos ? integer_width : float_width;
    if (line.size() % width != 0)
        file.wrong(fmt::format("the last line, {}, is not ended: the file may be cut short", in_quotes(line)));
}

} // namespace isotet::io::confined
