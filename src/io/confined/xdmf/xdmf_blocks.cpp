// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/xdmf/xdmf_blocks.hpp"

#include <functional>
#include <unordered_map>
#include <utility>

#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {
namespace {

constexpr std::size_t long_text = 256;
constexpr int deepest_data = 16;

/// Equal where elements name the same data in the same way: what they are, without their names and what they state of
/// sizes that the data itself has.
class DataKey {
public:
    explicit DataKey(const XdmfDocument& document) : document_(document) {}

    std::string of(pugi::xml_node node) const {
        std::string key;
        add(node, 0, key);
        return key;
    }

private:
    void add(pugi::xml_node node, int depth, std::string& key) const {
        key += std::string(node.name()) + "{";
        for (const char* name : {"TopologyType", "GeometryType", "Type", "ItemType", "Format", "Function", "BaseOffset",
                                 "Order", "NodesPerElement", "Seek", "Endian"})
            if (const pugi::xml_attribute attribute = node.attribute(name))
                key += fmt::format("{}={};", name, attribute.as_string());
        const bool heavy = same_word(node.attribute("Format").as_string(), "HDF");
        const auto items = document_.children(node, "DataItem");
        if (heavy || items.empty()) add_text(node, key);
        if (!heavy && items.empty())
            for (const char* name : {"Dimensions", "NumberOfElements", "NumberType", "DataType", "Precision"})
                key += fmt::format("{}={};", name, node.attribute(name).as_string());
        for (const pugi::xml_node item : items)
            if (const pugi::xml_node resolved = document_.resolve(item); resolved && depth < deepest_data)
                add(resolved, depth + 1, key);
        key += "}";
    }
    void add_text(pugi::xml_node node, std::string& key) const {
        std::string text = text_of(node);
        if (text.size() > long_text)
            text = fmt::format("{} characters {:x}", text.size(), std::hash<std::string_view>()(text));
        key += fmt::format("{}:{}", document_.file_of(node), text);
    }

    const XdmfDocument& document_;
};

} // namespace

Result<XdmfBlocks> blocks_of(const XdmfFile& file, const XdmfSteps& steps, const XdmfStep& step) {
    const DataKey key(file.document);
    XdmfBlocks solid, flat;
    std::unordered_map<std::string, std::size_t> places;
    for (const std::uint32_t number : step.grids) {
        const XdmfGrid& grid = steps.grids[number];
        const pugi::xml_node geometry = file.document.resolve(file.document.child(grid.node, "Geometry")),
                             topology = file.document.resolve(file.document.child(grid.node, "Topology"));
        if (!geometry || !topology) {
            solid.left_out.push_back({"grid", grid.name, "it lacks Geometry or Topology"});
            continue;
        }
        XdmfBlocks& kind = is_flat(topology) ? flat : solid;
        std::string points = key.of(geometry);
        const auto [place, is_new] = places.try_emplace(points + key.of(topology), kind.blocks.size());
        if (is_new) kind.blocks.push_back({grid.name, geometry, topology, std::move(points), {}});
        kind.blocks[place->second].grids.push_back(grid.node);
    }
    if (solid.blocks.empty() && flat.blocks.empty())
        return broken(file.path, solid.left_out.empty() ? std::string("its time step has no grid")
                                                        : fmt::format("grid \"{}\" cannot be read: {}",
                                                                      escaped(solid.left_out.front().name),
                                                                      solid.left_out.front().reason));
    if (solid.blocks.empty()) std::swap(solid.blocks, flat.blocks);
    for (const XdmfBlock& block : flat.blocks)
        solid.left_out.push_back({"grid", block.name, "its cells have no volume"});
    return solid;
}

} // namespace isotet::io::confined
