// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Points and elements of an MSH file of any version, and what is there more than once.
#include <string_view>

#include <fmt/core.h>

#include "io/gmsh/read_gmsh_parts.hpp"

namespace isotet::io::gmsh {

namespace {

bool is_version_4(const File& file) { return file.version == Version::v40 || file.version == Version::v41; }

Result<void> read_nodes(const File& file, const Section& nodes, Mesh& mesh, Pace& pace) {
    return is_version_4(file) ? read_nodes_4(file, nodes, mesh, pace) : read_nodes_2(file, nodes, mesh, pace);
}

Result<void> read_elements(const File& file, const Section& elements, const Wants& wants, Mesh& mesh, Pace& pace) {
    mesh.cells = CellList(mesh.nodes.size());
    auto read = is_version_4(file) ? read_elements_4(file, elements, wants, mesh, pace)
                                   : read_elements_2(file, elements, wants, mesh, pace);
    return read && wants.element_numbers ? mesh.elements.close("element") : read;
}

/// True where a section of the name occurs again with other bytes than the first of them.
bool differs(const File& file, const Section& first) {
    for (const Section& section : file.sections)
        if (section.name == first.name && section.body != first.body) return true;
    return false;
}

Error is_another(const Section& section, std::uint64_t first, std::uint64_t again, std::string_view what) {
    return broken(section,
                  first == again
                      ? fmt::format("occurs twice, with other numbers of {}: a file has one mesh", what)
                      : fmt::format("occurs twice, with {} and with {} {}: a file has one mesh", first, again, what));
}

/// Sections of other bytes must have the same numbers, in the same order.
Result<void> check_repeats(const File& file, const Mesh& mesh, Pace& pace) {
    Wants numbers;
    numbers.element_numbers = true;
    const Section* const nodes = file.find(file.name_of_nodes());
    const Section* const elements = file.find(file.name_of_elements());
    for (const Section& section : file.sections) {
        Mesh again;
        if (section.name == nodes->name && section.body != nodes->body) {
            if (auto read = read_nodes(file, section, again, pace); !read) return read;
            if (again.nodes == mesh.nodes) continue;
            return is_another(section, mesh.nodes.size(), again.nodes.size(), "nodes");
        }
        if (section.name != elements->name || section.body == elements->body) continue;
        again.nodes = mesh.nodes;
        if (auto read = read_elements(file, section, numbers, again, pace); !read) return read;
        if (again.elements == mesh.elements) continue;
        return is_another(section, mesh.elements.size(), again.elements.size(), "elements");
    }
    return {};
}

} // namespace

Result<Wants> tags_of(const File& file) { return is_version_4(file) ? tags_of_4(file) : tags_of_2(file); }

Result<Mesh> read_mesh(const File& file, const Wants& wants, Pace& pace) {
    const auto nodes = first_section(file, file.name_of_nodes());
    if (!nodes) return nodes.error();
    const auto elements = first_section(file, file.name_of_elements());
    if (!elements) return elements.error();
    Wants all = wants;
    all.element_numbers = wants.element_numbers || differs(file, **elements);
    Mesh mesh;
    if (auto read = read_nodes(file, **nodes, mesh, pace); !read) return read.error();
    if (auto read = read_elements(file, **elements, all, mesh, pace); !read) return read.error();
    if (auto same = check_repeats(file, mesh, pace); !same) return same.error();
    return mesh;
}

Totals totals_of(const File& file) {
    Totals totals;
    const auto total = [&](std::string_view name, std::uint64_t& to) {
        const Section* section = file.find(name);
        if (!section) return;
        with_source(*section, [&](auto& source) {
            std::int64_t blocks = 0, count = 0;
            const bool known =
                is_version_4(file) ? source.count(blocks) && source.count(count) : source.count_line(count);
            if (known && count >= 0) to = static_cast<std::uint64_t>(count);
        });
    };
    total(file.name_of_nodes(), totals.nodes);
    total(file.name_of_elements(), totals.elements);
    return totals;
}

} // namespace isotet::io::gmsh
