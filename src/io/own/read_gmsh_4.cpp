// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// $Entities, $Nodes and $Elements of MSH 4.1, ascii and binary.
#include <map>
#include <utility>

#include <fmt/core.h>

#include "io/own/read_gmsh_parts.hpp"

namespace isotet::io::gmsh {

namespace {

/// Dimension and number of an entity -> its first physical group.
using PhysicalGroups = std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t>;

/// Reads a count and as many integers; gives the first.
template <class Source>
bool read_list(Source& source, std::int32_t& first, bool& any) {
    std::int64_t count = 0;
    if (!source.number(count) || count < 0) return false;
    any = count > 0;
    for (std::int64_t i = 0; i < count; ++i) {
        std::int32_t value = 0;
        if (!source.integer(value)) return false;
        if (i == 0) first = value;
    }
    return true;
}

template <class Source>
bool read_entity(Source& source, std::int32_t dimension, PhysicalGroups& groups) {
    std::int32_t number = 0, group = 0, bound = 0;
    if (!source.integer(number)) return false;
    double coordinate = 0;
    for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i) {
        if (!source.real(coordinate)) return false;
    }
    bool has_group = false, has_bounds = false;
    if (!read_list(source, group, has_group)) return false;
    if (has_group) groups[{dimension, number}] = group;
    return dimension == 0 || read_list(source, bound, has_bounds);
}

template <class Source>
Result<PhysicalGroups> read_entities(const Section& section, Source& source) {
    PhysicalGroups groups;
    std::int64_t counts[4];
    for (std::int64_t& count : counts) {
        if (!source.number(count) || count < 0)
            return broken(section, "has no numbers of points, curves, surfaces and volumes");
    }
    for (std::int32_t dimension = 0; dimension < 4; ++dimension) {
        for (std::int64_t i = 0; i < counts[dimension]; ++i) {
            if (!read_entity(source, dimension, groups)) {
                return broken(
                    section, fmt::format("states {} entities of dimension {}, but entity {} is broken or missing at {}",
                                         counts[dimension], dimension, i + 1, source.where()));
            }
        }
    }
    if (const auto finished = finish_section(section, source); !finished) return finished.error();
    return groups;
}

Result<PhysicalGroups> physical_groups(const File& file) {
    const Section* section = file.find("Entities");
    if (!section) return PhysicalGroups{};
    return with_source(file, *section, [&](auto& source) { return read_entities(*section, source); });
}

/// The numbers that $Nodes and $Elements start with; lowest and highest number are not needed.
struct Counts {
    std::int64_t blocks = 0, total = 0;
};

template <class Source>
Result<Counts> read_counts(const Section& section, Source& source, const char* what, std::size_t numbers,
                           std::size_t reals) {
    Counts counts;
    std::int64_t lowest = 0, highest = 0;
    if (!source.number(counts.blocks) || !source.number(counts.total) || !source.number(lowest) ||
        !source.number(highest)) {
        return broken(section, fmt::format("has no numbers of blocks and {}s, at {}", what, source.where()));
    }
    const std::uint64_t max_blocks = source.records_left(3, 1, 0), most = source.records_left(0, numbers, reals);
    if (counts.blocks < 0 || static_cast<std::uint64_t>(counts.blocks) > max_blocks) {
        return broken(section,
                      fmt::format("states {} blocks, but there is room for {} at most", counts.blocks, max_blocks));
    }
    if (counts.total < 0 || static_cast<std::uint64_t>(counts.total) > most) {
        return broken(section,
                      fmt::format("states {} {}s, but there is room for {} at most", counts.total, what, most));
    }
    return counts;
}

/// The header of a block: `kind` is "parametric" in $Nodes, the type in $Elements.
struct Block {
    std::int32_t dimension = 0, entity = 0, kind = 0;
    std::int64_t count = 0;
};

template <class Source>
Result<Block> read_block(const Section& section, Source& source, const Counts& counts, std::int64_t index,
                         std::int64_t done) {
    Block block;
    if (!source.integer(block.dimension) || !source.integer(block.entity) || !source.integer(block.kind) ||
        !source.number(block.count)) {
        return broken(section, fmt::format("states {} blocks, but block {} is broken or missing at {}", counts.blocks,
                                           index + 1, source.where()));
    }
    if (block.count < 0 || block.count > counts.total - done) {
        return broken(section, fmt::format("block {} states {} entries, but {} of the stated {} are left", index + 1,
                                           block.count, counts.total - done, counts.total));
    }
    if (block.dimension < 0 || block.dimension > 3) {
        return broken(section,
                      fmt::format("block {} has dimension {}, but 0 to 3 is the rule", index + 1, block.dimension));
    }
    return block;
}

template <class Source>
Result<void> read_nodes_4(const Section& section, Source& source, Mesh& mesh, Pace& pace) {
    const auto counts = read_counts(section, source, "node", 1, 3);
    if (!counts) return counts.error();
    mesh.points.reserve(3 * static_cast<std::size_t>(counts->total));
    std::int64_t done = 0;
    const auto missing = [&](std::int64_t entry) {
        return broken(section, fmt::format("states {} nodes, but node {} is broken or missing at {}", counts->total,
                                           entry + 1, source.where()));
    };
    for (std::int64_t index = 0; index < counts->blocks; ++index) {
        const auto block = read_block(section, source, *counts, index, done);
        if (!block) return block.error();
        for (std::int64_t i = 0; i < block->count; ++i) {
            std::int64_t number = 0;
            if (!source.number(number)) return missing(done + i);
            mesh.nodes.add(number);
            if (!pace.goes_on(source.position())) return Pace::cancelled();
        }
        const std::int32_t parameters = block->kind != 0 ? block->dimension : 0;
        for (std::int64_t i = 0; i < block->count; ++i) {
            double x = 0, y = 0, z = 0, parameter = 0;
            bool whole = source.real(x) && source.real(y) && source.real(z);
            for (std::int32_t p = 0; p < parameters; ++p) whole = whole && source.real(parameter);
            if (!whole) return missing(done + i);
            mesh.points.insert(mesh.points.end(), {x, y, z});
            if (!pace.goes_on(source.position())) return Pace::cancelled();
        }
        done += block->count;
    }
    if (done != counts->total)
        return broken(section, fmt::format("states {} nodes, but its blocks hold {}", counts->total, done));
    if (const auto closed = mesh.nodes.close("node"); !closed) return broken(section, closed.error().message);
    return finish_section(section, source);
}

template <class Source>
Result<void> read_elements_4(const Section& section, Source& source, const Wants& wants, const PhysicalGroups& groups,
                             Mesh& mesh, Pace& pace) {
    const auto counts = read_counts(section, source, "element", 2, 0);
    if (!counts) return counts.error();
    mesh.cells.reserve(4 * static_cast<std::uint64_t>(counts->total));
    std::vector<std::uint64_t> points;
    std::int64_t done = 0;
    for (std::int64_t index = 0; index < counts->blocks; ++index) {
        const auto block = read_block(section, source, *counts, index, done);
        if (!block) return block.error();
        const auto type = element_type(block->kind);
        if (!type)
            return broken(section,
                          fmt::format("block {} has type {}, which isotet does not know", index + 1, block->kind));
        const std::uint64_t most = source.records_left(0, type->nodes + 1, 0);
        if (static_cast<std::uint64_t>(block->count) > most) {
            return broken(section, fmt::format("block {} states {} elements, but there is room for {} at most",
                                               index + 1, block->count, most));
        }
        for (std::int64_t i = 0; i < block->count; ++i, ++done) {
            std::int64_t number = 0, node = 0;
            bool whole = source.number(number);
            points.clear();
            for (std::uint32_t n = 0; n < type->nodes; ++n) {
                whole = whole && source.number(node);
                if (!whole) {
                    return broken(section, fmt::format("states {} elements, but element {} is broken or missing at {}",
                                                       counts->total, done + 1, source.where()));
                }
                const std::uint64_t point = mesh.nodes.find(node);
                if (point == NumberMap::none) {
                    return broken(section,
                                  fmt::format("element {} has node {}, which is not among the nodes", number, node));
                }
                points.push_back(point);
            }
            add_element(mesh.cells, *type, points);
            if (wants.element_numbers) mesh.elements.add(number);
            if (!pace.goes_on(source.position())) return Pace::cancelled();
        }
        const auto group = groups.find({block->dimension, block->entity});
        if (wants.physical) mesh.physical.resize(mesh.cells.size(), group == groups.end() ? 0 : group->second);
        if (wants.geometrical) mesh.geometrical.resize(mesh.cells.size(), block->entity);
    }
    if (done != counts->total) {
        return broken(section, fmt::format("states {} elements, but its blocks hold {}", counts->total, done));
    }
    return finish_section(section, source);
}

} // namespace

Result<Wants> tags_of_4(const File& file) {
    const auto groups = physical_groups(file);
    if (!groups) return groups.error();
    return Wants{!groups->empty(), true, false};
}

Result<Mesh> read_mesh_4(const File& file, const Wants& wants, Pace& pace) {
    const auto nodes = only_section(file, "Nodes");
    if (!nodes) return nodes.error();
    const auto elements = only_section(file, "Elements");
    if (!elements) return elements.error();
    const auto groups = physical_groups(file);
    if (!groups) return groups.error();

    Mesh mesh;
    auto read = with_source(file, **nodes, [&](auto& source) { return read_nodes_4(**nodes, source, mesh, pace); });
    if (!read) return read.error();
    mesh.cells = CellList(mesh.nodes.size());
    read = with_source(file, **elements,
                       [&](auto& source) { return read_elements_4(**elements, source, wants, *groups, mesh, pace); });
    if (!read) return read.error();
    return mesh;
}

} // namespace isotet::io::gmsh
