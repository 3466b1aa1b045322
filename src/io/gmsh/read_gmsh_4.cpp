// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// $Entities, $PartitionedEntities, $Nodes and $Elements of MSH 4.0 and 4.1, ascii and binary.
#include <algorithm>
#include <map>
#include <utility>

#include <fmt/core.h>

#include "io/gmsh/read_gmsh_parts.hpp"

namespace isotet::io::gmsh {

namespace {

/// What the elements of an entity have; of the partitions the first.
struct Entity {
    Tags tags;
    std::vector<std::int32_t> other_groups = {}; ///< physical ones, but the first
};

/// By dimension and number.
using Entities = std::map<std::pair<std::int32_t, std::int32_t>, Entity>;

constexpr std::int32_t volume = 3; ///< the dimension

/// Reads a count and as many integers: the first, and the others where they are wanted.
template <class Source>
bool read_list(Source& source, std::int32_t& first, std::vector<std::int32_t>* others = nullptr) {
    std::int64_t count = 0;
    if (!source.count(count) || count < 0) return false;
    for (std::int64_t i = 0; i < count; ++i) {
        std::int32_t value = 0;
        if (!source.integer(value)) return false;
        if (i == 0) first = value;
        else if (others) others->push_back(value);
    }
    return true;
}

/// An entity of $PartitionedEntities has that which was cut, and partitions.
template <class Source>
bool read_entity(Source& source, const File& file, std::int32_t dimension, bool partitioned, Entities& entities) {
    std::int32_t number = 0, bound = 0, parent_dimension = 0, parent = 0;
    if (!source.integer(number)) return false;
    Entity entity;
    Tags& tags = entity.tags;
    tags.geometrical = number;
    if (partitioned) {
        if (!source.integer(parent_dimension) || !source.integer(parent) || !read_list(source, tags.partition))
            return false;
        if (parent_dimension == dimension) {
            const auto whole = entities.find({dimension, parent});
            if (whole != entities.end()) {
                tags.physical = whole->second.tags.physical;
                entity.other_groups = whole->second.other_groups;
            }
            tags.geometrical = parent;
        }
    }
    double coordinate = 0;
    for (int i = 0; i < (dimension == 0 && file.version == Version::v41 ? 3 : 6); ++i) {
        if (!source.real(coordinate)) return false;
    }
    std::vector<std::int32_t> groups;
    if (!read_list(source, tags.physical, &groups)) return false;
    if (!groups.empty()) entity.other_groups = std::move(groups);
    entities[{dimension, number}] = std::move(entity);
    return dimension == 0 || read_list(source, bound);
}

template <class Source>
Result<void> read_entities(const Section& section, Source& source, const File& file, bool partitioned,
                           Entities& entities) {
    if (partitioned) {
        std::int64_t partitions = 0, ghosts = 0;
        bool whole = source.count(partitions) && source.count(ghosts) && ghosts >= 0;
        for (std::int64_t i = 0; whole && i < ghosts; ++i) {
            std::int32_t number = 0;
            Tags tags;
            tags.left_out = true;
            whole = source.integer(number) && source.integer(tags.partition);
            entities[{volume, number}] = {tags};
        }
        if (!whole) return broken(section, "has no numbers of partitions and ghost entities");
    }
    std::int64_t counts[4];
    for (std::int64_t& count : counts) {
        if (!source.count(count) || count < 0)
            return broken(section, "has no numbers of points, curves, surfaces and volumes");
    }
    for (std::int32_t dimension = 0; dimension < 4; ++dimension) {
        for (std::int64_t i = 0; i < counts[dimension]; ++i) {
            if (!read_entity(source, file, dimension, partitioned, entities)) {
                return broken(
                    section, fmt::format("states {} entities of dimension {}, but entity {} is broken or missing at {}",
                                         counts[dimension], dimension, i + 1, source.where()));
            }
        }
    }
    return finish_section(section, source);
}

Result<Entities> entities_of(const File& file) {
    Entities entities;
    for (const char* name : {"Entities", "PartitionedEntities"}) {
        const Section* section = file.find(name);
        if (!section) continue;
        const bool partitioned = section->name != "Entities";
        auto read = with_source(
            *section, [&](auto& source) { return read_entities(*section, source, file, partitioned, entities); });
        if (!read) return read.error();
    }
    return entities;
}

/// The numbers that $Nodes and $Elements start with; lowest and highest number are not needed.
struct Counts {
    std::int64_t blocks = 0, total = 0;
};

template <class Source>
Result<Counts> read_counts(const File& file, const Section& section, Source& source, const char* what,
                           std::size_t numbers, std::size_t reals) {
    Counts counts;
    std::int64_t lowest = 0, highest = 0;
    if (!source.count(counts.blocks) || !source.count(counts.total) ||
        (file.version == Version::v41 && (!source.count(lowest) || !source.count(highest)))) {
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
Result<Block> read_block(const File& file, const Section& section, Source& source, const Counts& counts,
                         std::int64_t index, std::int64_t done) {
    Block block;
    const bool entity_first = file.version == Version::v40;
    if (!source.integer(entity_first ? block.entity : block.dimension) ||
        !source.integer(entity_first ? block.dimension : block.entity) || !source.integer(block.kind) ||
        !source.count(block.count)) {
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

/// Numbers of a block's nodes, then their coordinates; in 4.0 number and coordinates of each node.
template <class Source>
bool read_nodes_of_block(Source& source, const Block& block, bool by_node, Mesh& mesh, Pace& pace, std::int64_t& done) {
    const std::int32_t parameters = block.kind != 0 ? block.dimension : 0;
    const auto read_number = [&] {
        std::int64_t number = 0;
        if (!source.number(number)) return false;
        mesh.nodes.add(number);
        return true;
    };
    for (std::int64_t i = 0; !by_node && i < block.count; ++i)
        if (!read_number() || !pace.goes_on(source.position())) return false;
    for (std::int64_t i = 0; i < block.count; ++i, ++done) {
        if (by_node && !read_number()) return false;
        double x = 0, y = 0, z = 0, parameter = 0;
        bool whole = source.real(x) && source.real(y) && source.real(z);
        for (std::int32_t p = 0; p < parameters; ++p) whole = whole && source.real(parameter);
        if (!whole) return false;
        mesh.points.insert(mesh.points.end(), {x, y, z});
        if (!pace.goes_on(source.position())) return false;
    }
    return true;
}

template <class Source>
Result<void> read_nodes_from(const File& file, const Section& section, Source& source, Mesh& mesh, Pace& pace) {
    const auto counts = read_counts(file, section, source, "node", 1, 3);
    if (!counts) return counts.error();
    mesh.points.reserve(3 * static_cast<std::size_t>(counts->total));
    std::int64_t done = 0;
    for (std::int64_t index = 0; index < counts->blocks; ++index) {
        const auto block = read_block(file, section, source, *counts, index, done);
        if (!block) return block.error();
        if (read_nodes_of_block(source, *block, file.version == Version::v40, mesh, pace, done)) continue;
        if (!pace.goes_on(source.position())) return Pace::cancelled();
        return broken(section, fmt::format("states {} nodes, but node {} is broken or missing at {}", counts->total,
                                           done + 1, source.where()));
    }
    if (done != counts->total)
        return broken(section, fmt::format("states {} nodes, but its blocks hold {}", counts->total, done));
    if (const auto closed = mesh.nodes.close("node"); !closed) return broken(section, closed.error().message);
    return finish_section(section, source);
}

/// With the first of the groups that are chosen, where the entity is in one; else with its first.
Tags tags_for(const Entity& entity, std::int32_t dimension,
              const std::vector<std::pair<std::int32_t, std::int32_t>>& chosen) {
    Tags tags = entity.tags;
    const auto is_chosen = [&](std::int32_t group) {
        return std::ranges::find(chosen, std::pair(dimension, group)) != chosen.end();
    };
    if (is_chosen(tags.physical)) return tags;
    const auto other = std::ranges::find_if(entity.other_groups, is_chosen);
    if (other != entity.other_groups.end()) tags.physical = *other;
    return tags;
}

template <class Source>
Result<void> read_elements_from(const File& file, const Section& section, Source& source, const Wants& wants,
                                const Entities& entities, Mesh& mesh, Pace& pace) {
    const auto counts = read_counts(file, section, source, "element", 2, 0);
    if (!counts) return counts.error();
    mesh.cells.reserve(4 * static_cast<std::uint64_t>(counts->total));
    std::vector<std::uint64_t> points;
    std::int64_t done = 0;
    for (std::int64_t index = 0; index < counts->blocks; ++index) {
        const auto block = read_block(file, section, source, *counts, index, done);
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
        const auto entity = entities.find({block->dimension, block->entity});
        const Tags tags = entity == entities.end() ? Tags{0, block->entity, 0, false}
                                                   : tags_for(entity->second, block->dimension, wants.groups);
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
            mesh.add_element(wants, *type, number, points, tags);
            if (!pace.goes_on(source.position())) return Pace::cancelled();
        }
    }
    if (done != counts->total) {
        return broken(section, fmt::format("states {} elements, but its blocks hold {}", counts->total, done));
    }
    return finish_section(section, source);
}

} // namespace

Result<Wants> tags_of_4(const File& file) {
    const auto entities = entities_of(file);
    if (!entities) return entities.error();
    Wants wants;
    wants.geometrical = true;
    for (const auto& [numbers, entity] : *entities) {
        wants.physical = wants.physical || entity.tags.physical != 0;
        wants.partition = wants.partition || entity.tags.partition != 0;
    }
    return wants;
}

Result<void> read_nodes_4(const File& file, const Section& nodes, Mesh& mesh, Pace& pace) {
    return with_source(nodes, [&](auto& source) { return read_nodes_from(file, nodes, source, mesh, pace); });
}

Result<void> read_elements_4(const File& file, const Section& elements, const Wants& wants, Mesh& mesh, Pace& pace) {
    const auto entities = entities_of(file);
    if (!entities) return entities.error();
    return with_source(elements, [&](auto& source) {
        return read_elements_from(file, elements, source, wants, *entities, mesh, pace);
    });
}

} // namespace isotet::io::gmsh
