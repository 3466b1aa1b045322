// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/ensight_gold.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include <fmt/core.h>

#include "io/own/loaded.hpp"
#include "io/vtk/ensight_case.hpp"
#include "io/vtk/gold_file.hpp"

namespace isotet::io::vtk {
namespace {

struct GoldPart {
    std::uint64_t nodes = 0, cells = 0; ///< cells: of a structured part
    std::map<std::string, std::uint64_t, std::less<>> elements;
};
using GoldParts = std::map<std::uint64_t, GoldPart>;

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

/// Numbers of nodes and elements are there when the file says so.
bool has_ids(std::string_view line) { return line.ends_with("given") || line.ends_with("ignore"); }

std::uint64_t sum_of(GoldFile& file, const std::vector<std::uint64_t>& counts) {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : counts) {
        if (count > file.left()) file.wrong(fmt::format("an element has {} nodes or faces", count));
        sum += count;
    }
    return sum;
}

void walk_elements(GoldFile& file, GoldPart& part, bool ids) {
    while (!file.at_end()) {
        const std::string type(file.peek("a part"));
        if (type.starts_with("part")) return;
        file.line("a type of elements");
        const bool sided = type == "nsided" || type == "g_nsided", faced = type == "nfaced" || type == "g_nfaced";
        const std::uint64_t nodes = nodes_of_element(type);
        if (nodes == 0 && !sided && !faced)
            file.wrong(fmt::format("\"{}\" is no type of elements", type.substr(0, 80)));
        const std::uint64_t count = file.count("the number of elements");
        part.elements[type] = count;
        if (ids) file.skip_numbers(count, "the list of elements");
        if (count > file.left()) file.skip_numbers(count, "the connectivity");
        if (sided) {
            file.skip_numbers(sum_of(file, file.counts(count, "the corners of polygons")), "the connectivity");
        } else if (faced) {
            const std::uint64_t faces = sum_of(file, file.counts(count, "the faces of polyhedra"));
            file.skip_numbers(sum_of(file, file.counts(faces, "the corners of faces")), "the connectivity");
        } else {
            file.skip_numbers(count * nodes, "the connectivity");
        }
    }
}

void walk_block(GoldFile& file, GoldPart& part, std::string_view kind) {
    std::array<std::uint64_t, 3> size{};
    const auto sizes = file.counts(3, "the size of a block");
    std::uint64_t nodes = 1, cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        size[axis] = sizes[axis];
        if (size[axis] == 0 || nodes > file.left() / size[axis] + file.left())
            file.wrong(fmt::format("a block has {} x {} x {} nodes", sizes[0], sizes[1], sizes[2]));
        nodes *= size[axis];
        cells *= std::max<std::uint64_t>(size[axis] - 1, 1);
    }
    part.nodes = nodes;
    part.cells = cells;
    const bool rectilinear = kind.find("rectilinear") != std::string_view::npos;
    if (kind.find("uniform") != std::string_view::npos) file.skip_numbers(6, "the origin and spacing of a block");
    else if (rectilinear)
        for (const std::uint64_t along : size) file.skip_numbers(along, "the coordinates of a block");
    else
        for (int axis = 0; axis < 3; ++axis) file.skip_numbers(nodes, "the coordinates of a block");
    if (kind.find("iblanked") != std::string_view::npos) file.skip_numbers(nodes, "the blanking of a block");
    if (kind.find("with_ghost") == std::string_view::npos) return;
    file.line("ghost flags");
    file.skip_numbers(cells, "the ghost flags of a block");
}

/// Nothing where the file has several steps.
std::optional<GoldParts> walk_geometry(GoldFile& file) {
    if (file.is_binary()) file.line("its form");
    if (file.line("its description").find("BEGIN TIME STEP") != std::string_view::npos) return std::nullopt;
    file.line("its description");
    const bool node_ids = has_ids(file.line("\"node id\"")), element_ids = has_ids(file.line("\"element id\""));
    GoldParts parts;
    if (!file.at_end() && file.peek("a part").starts_with("extents")) {
        file.line("extents");
        file.skip_numbers(6, "the extents");
    }
    while (!file.at_end()) {
        if (const auto line = file.line("a part"); !line.starts_with("part"))
            file.wrong(fmt::format("\"{}\" stands where a part was expected", line.substr(0, 80)));
        GoldPart& part = parts[file.part_number()];
        file.line("the description of a part");
        const std::string kind(file.line("the coordinates of a part"));
        if (kind.starts_with("block")) {
            walk_block(file, part, kind);
            continue;
        }
        if (!kind.starts_with("coordinates"))
            file.wrong(fmt::format("\"{}\" stands where coordinates were expected", kind.substr(0, 80)));
        part.nodes = file.count("the number of nodes");
        if (node_ids) file.skip_numbers(part.nodes, "the list of nodes");
        for (int axis = 0; axis < 3; ++axis) file.skip_numbers(part.nodes, "the coordinates");
        walk_elements(file, part, element_ids);
    }
    return parts;
}

void walk_variable(GoldFile& file, const GoldCase::Variable& variable, const GoldParts& parts) {
    if (file.line("its description").find("BEGIN TIME STEP") != std::string_view::npos) return;
    do {
        if (const auto line = file.line("a part"); !line.starts_with("part"))
            file.wrong(fmt::format("\"{}\" stands where a part was expected: values are missing, or too many",
                                   line.substr(0, 80)));
        const std::uint64_t number = file.part_number();
        const auto found = parts.find(number);
        if (found == parts.end()) file.wrong(fmt::format("the geometry has no part {}", number));
        const GoldPart& part = found->second;
        do {
            const std::string kind(file.line("the kind of values of a part"));
            if (kind.find("undef") != std::string::npos || kind.find("partial") != std::string::npos) return;
            std::uint64_t values = 0;
            if (kind.starts_with("coordinates")) values = part.nodes;
            else if (kind.starts_with("block")) values = variable.of_nodes ? part.nodes : part.cells;
            else if (const auto of = part.elements.find(kind); of != part.elements.end()) values = of->second;
            else file.wrong(fmt::format("part {} has no elements \"{}\"", number, kind.substr(0, 80)));
            for (std::size_t c = 0; c < variable.components; ++c) file.skip_numbers(values, "the values of a part");
        } while (!file.at_end() && !file.peek("values").starts_with("part"));
    } while (!file.at_end());
}

/// Nothing where it is not there: VTK's reader tells.
std::optional<MappedFile> opened(const std::string& path) {
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
    auto file = MappedFile::open(path);
    if (!file) throw GoldError(file.error());
    if (file->bytes().empty()) throw GoldError(broken(path, "the file is empty"));
    return *std::move(file);
}

} // namespace

Result<void> check_ensight_gold(const std::string& case_file, std::size_t step) {
    const auto text = MappedFile::open(case_file);
    if (!text) return text.error();
    const GoldCase found = parse_case(text->text());
    if (!found.is_gold) return {};
    const auto path_of = [&](const std::string& name) -> std::optional<std::string> {
        const auto of_step = name_of_step(found, name, step);
        if (!of_step) return std::nullopt;
        return (std::filesystem::path(case_file).parent_path() / *of_step).string();
    };
    try {
        const auto model = path_of(found.model);
        const auto geometry = model ? opened(*model) : std::nullopt;
        if (!geometry) return {};
        GoldFile file(*model, *geometry);
        const auto parts = walk_geometry(file);
        if (!parts) return {};
        for (const GoldCase::Variable& variable : found.variables) {
            const auto path = path_of(variable.name);
            const auto values = path ? opened(*path) : std::nullopt;
            if (!values) continue;
            GoldFile walked(*path, *values);
            walk_variable(walked, variable, *parts);
        }
    } catch (const GoldError& error) {
        return error.error();
    }
    return {};
}

} // namespace isotet::io::vtk
