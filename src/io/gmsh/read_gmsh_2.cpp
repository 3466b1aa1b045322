// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// $Nodes, $ParametricNodes and $Elements of MSH 2.0 to 2.2, ascii and binary; $NOD and $ELM of 1.0, always ascii.
#include <fmt/core.h>

#include "io/gmsh/read_gmsh_parts.hpp"

namespace isotet::io::gmsh {

namespace {

/// $ParametricNodes has, after the coordinates, the dimension and number of an entity and a parameter for each
/// dimension (none in volumes).
template <class Source>
bool skip_parameters(Source& source) {
    std::int32_t dimension = 0, entity = 0;
    if (!source.integer(dimension) || !source.integer(entity)) return false;
    double parameter = 0;
    for (int i = 0; i < (dimension == 1 || dimension == 2 ? dimension : 0); ++i) {
        if (!source.real(parameter)) return false;
    }
    return true;
}

template <class Source>
Result<void> read_nodes_from(const Section& section, Source& source, Mesh& mesh, Pace& pace) {
    const bool parametric = section.name == "ParametricNodes";
    std::int64_t count = 0;
    if (!source.count_line(count)) return broken(section, "has no number of nodes, at " + source.where());
    const std::uint64_t most = source.records_left(parametric ? 2 : 0, 1, 3);
    if (count < 0 || static_cast<std::uint64_t>(count) > most) {
        return broken(section, fmt::format("states {} nodes, but there is room for {} at most", count, most));
    }
    mesh.points.reserve(3 * static_cast<std::size_t>(count));
    for (std::int64_t i = 0; i < count; ++i) {
        std::int64_t number = 0;
        double x = 0, y = 0, z = 0;
        if (!source.number(number) || !source.real(x) || !source.real(y) || !source.real(z) ||
            (parametric && !skip_parameters(source))) {
            return broken(section, fmt::format("states {} nodes, but node {} is broken or missing at {}", count, i + 1,
                                               source.where()));
        }
        mesh.nodes.add(number);
        mesh.points.insert(mesh.points.end(), {x, y, z});
        if (!pace.goes_on(source.position())) return Pace::cancelled();
    }
    if (const auto closed = mesh.nodes.close("node"); !closed) return broken(section, closed.error().message);
    return finish_section(section, source);
}

/// Cells that follow one header: one in ascii files, any number in binary ones.
struct ElementBlock {
    std::int64_t number = 0; ///< of the first element, ascii only
    std::int32_t type = 0, count = 1, tags = 0;
};

template <class Source>
bool read_block_header(Source& source, Version version, ElementBlock& block) {
    if constexpr (Source::is_text) {
        if (!source.number(block.number) || !source.integer(block.type)) return false;
        block.tags = 2;
        return version == Version::v1 || source.integer(block.tags);
    } else {
        return source.integer(block.type) && source.integer(block.count) && source.integer(block.tags);
    }
}

/// Physical group, entity, number of partitions, those partitions, of which the first has the element; files before
/// version 2.2 have the partition in place of their number.
template <class Source>
bool read_tags(Source& source, std::int32_t count, Tags& tags) {
    for (std::int32_t t = 0; t < count; ++t) {
        std::int32_t tag = 0;
        if (!source.integer(tag)) return false;
        if (t == 0) tags.physical = tag;
        if (t == 1) tags.geometrical = tag;
        if (t == 2 || t == 3) tags.partition = tag;
    }
    return true;
}

/// Version 1.0 says how many nodes an element has.
template <class Source>
bool read_node_count(Source& source, Version version, const ElementType& type, std::int32_t& nodes) {
    nodes = static_cast<std::int32_t>(type.nodes);
    return version != Version::v1 || source.integer(nodes);
}

/// An element that is in several physical groups is there once for each of them, one after another.
class Repeats {
public:
    bool repeats(std::int32_t type, const std::vector<std::uint64_t>& points, std::int32_t group) {
        const bool same = type == type_ && points == points_ && group != group_;
        type_ = type;
        points_ = points;
        group_ = group;
        return same;
    }

private:
    std::int32_t type_ = 0, group_ = 0;
    std::vector<std::uint64_t> points_;
};

template <class Source>
Result<void> read_elements_from(const Section& section, Source& source, Version version, const Wants& wants, Mesh& mesh,
                                Pace& pace) {
    std::int64_t count = 0;
    if (!source.count_line(count)) return broken(section, "has no number of elements, at " + source.where());
    const std::uint64_t most = source.records_left(0, 2, 0);
    if (count < 0 || static_cast<std::uint64_t>(count) > most) {
        return broken(section, fmt::format("states {} elements, but there is room for {} at most", count, most));
    }
    mesh.cells.reserve(4 * static_cast<std::uint64_t>(count));
    const auto missing = [&](std::int64_t done) {
        return broken(section, fmt::format("states {} elements, but element {} is broken or missing at {}", count,
                                           done + 1, source.where()));
    };
    std::vector<std::uint64_t> points;
    Repeats last;
    for (std::int64_t done = 0; done < count;) {
        ElementBlock block;
        if (!read_block_header(source, version, block)) return missing(done);
        const auto type = element_type(block.type);
        if (!type)
            return broken(section,
                          fmt::format("element {} has type {}, which isotet does not know", done + 1, block.type));
        if (block.count < 1 || block.count > count - done || block.tags < 0) {
            return broken(section, fmt::format("a block of {} elements with {} tags at {}, but {} elements are left",
                                               block.count, block.tags, source.where(), count - done));
        }
        for (std::int32_t i = 0; i < block.count; ++i, ++done) {
            std::int64_t number = block.number;
            if (!Source::is_text && !source.number(number)) return missing(done);
            Tags tags;
            std::int32_t stated = 0;
            if (!read_tags(source, block.tags, tags) || !read_node_count(source, version, *type, stated))
                return missing(done);
            if (stated != static_cast<std::int32_t>(type->nodes))
                return broken(section, fmt::format("element {} of type {} states {} nodes, but has {}", number,
                                                   block.type, stated, type->nodes));
            points.clear();
            for (std::uint32_t n = 0; n < type->nodes; ++n) {
                std::int64_t node = 0;
                if (!source.number(node)) return missing(done);
                const std::uint64_t point = mesh.nodes.find(node);
                if (point == NumberMap::none) {
                    return broken(section,
                                  fmt::format("element {} has node {}, which is not among the nodes", number, node));
                }
                points.push_back(point);
            }
            tags.left_out = !wants.all_groups && last.repeats(block.type, points, tags.physical);
            mesh.repeats += tags.left_out;
            mesh.add_element(wants, *type, number, points, tags);
            if (!pace.goes_on(source.position())) return Pace::cancelled();
        }
    }
    return finish_section(section, source);
}

} // namespace

Result<Wants> tags_of_2(const File& file) {
    const auto section = first_section(file, file.name_of_elements());
    if (!section) return section.error();
    // The first element tells: Gmsh writes the same tags for all.
    return with_source(**section, [&](auto& source) {
        std::int64_t count = 0;
        ElementBlock block;
        Wants wants;
        if (!source.count_line(count) || count < 1 || !read_block_header(source, file.version, block))
            return Result<Wants>(wants);
        wants.physical = block.tags >= 1;
        wants.geometrical = block.tags >= 2;
        wants.partition = block.tags >= 3;
        return Result<Wants>(wants);
    });
}

Result<void> read_nodes_2(const File&, const Section& nodes, Mesh& mesh, Pace& pace) {
    return with_source(nodes, [&](auto& source) { return read_nodes_from(nodes, source, mesh, pace); });
}

Result<void> read_elements_2(const File& file, const Section& elements, const Wants& wants, Mesh& mesh, Pace& pace) {
    return with_source(
        elements, [&](auto& source) { return read_elements_from(elements, source, file.version, wants, mesh, pace); });
}

} // namespace isotet::io::gmsh
