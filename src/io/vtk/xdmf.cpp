// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// XDMF 2 and 3: unstructured uniform grids, in collections over time and space.
#include <optional>

#include <fmt/core.h>

#include "io/reader.hpp"
#include "io/own/text_scanner.hpp"
#include "io/own/escape.hpp"
#include "io/vtk/loaders.hpp"
#include "io/vtk/vtk_log.hpp"
#include "io/vtk/xdmf_data.hpp"

namespace isotet::io::vtk {
namespace {

struct Element {
    std::string_view name;
    int code;          ///< in mixed topologies
    std::uint8_t type; ///< VTK's
    unsigned corners;  ///< 0: stated before them
};
constexpr Element elements[] = {
    {"Polyvertex", 1, 2, 0},        {"Polyline", 2, 4, 0},
    {"Polygon", 3, 7, 0},           {"Triangle", 4, 5, 3},
    {"Quadrilateral", 5, 9, 4},     {"Tetrahedron", 6, 10, 4},
    {"Pyramid", 7, 14, 5},          {"Wedge", 8, 13, 6},
    {"Hexahedron", 9, 12, 8},       {"Edge_3", 34, 21, 3},
    {"Quadrilateral_9", 35, 28, 9}, {"Triangle_6", 36, 22, 6},
    {"Quadrilateral_8", 37, 23, 8}, {"Tetrahedron_10", 38, 24, 10},
    {"Tet_10", 38, 24, 10},         {"Pyramid_13", 39, 27, 13},
    {"Wedge_15", 40, 26, 15},       {"Wedge_18", 41, 32, 18},
    {"Hexahedron_20", 48, 25, 20},  {"Hex_20", 48, 25, 20},
    {"Hexahedron_27", 50, 29, 27},
};

std::string_view attribute(pugi::xml_node node, const char* name, const char* older_name) {
    const pugi::xml_attribute stated = node.attribute(name);
    return stated ? stated.as_string() : node.attribute(older_name).as_string();
}

class GridLoader {
public:
    GridLoader(const std::string& path, const XdmfDocument& document, const ReadOptions& options, Depth depth,
               Loaded& loaded)
        : path_(path),
          document_(document),
          data_(path, document, options.allow_outside),
          options_(options),
          depth_(depth),
          loaded_(loaded) {}

    Result<void> load(pugi::xml_node grid) {
        piece_.name = fmt::format("{} {}", path_, grid.attribute("Name").as_string());
        const pugi::xml_node geometry = document_.resolve(grid.child("Geometry")),
                             topology = document_.resolve(grid.child("Topology"));
        if (!geometry || !topology)
            return broken(path_, fmt::format("grid \"{}\" lacks Geometry or Topology", name(grid)));
        if (auto read = read_points(geometry); !read) return read;
        if (auto read = read_cells(topology); !read) return read;
        for (const pugi::xml_node stated : grid.children("Attribute")) {
            const pugi::xml_node field = document_.resolve(stated);
            if (!field) return broken(path_, "an Attribute refers to nothing");
            if (auto read = read_field(field); !read) return read;
        }
        if (depth_ == Depth::arrays) loaded_.pieces.push_back(std::move(piece_));
        return {};
    }

private:
    static std::string name(pugi::xml_node node) { return escaped(node.attribute("Name").as_string()); }

    Result<void> read_points(pugi::xml_node geometry) {
        const std::string_view type = attribute(geometry, "GeometryType", "Type");
        const bool flat = same_word(type, "XY");
        if (!type.empty() && !same_word(type, "XYZ") && !flat)
            return broken(path_, fmt::format("geometry of type \"{}\" is not read: XYZ and XY are", escaped(type)));
        auto values = data_.read(geometry.child("DataItem"), depth_);
        if (!values) return values.error();
        const std::uint64_t axes = flat ? 2 : 3;
        if (values->count() % axes != 0)
            return broken(path_, fmt::format("{} coordinates are no multiple of {}", values->count(), axes));
        points_ = values->count() / axes;
        if (depth_ == Depth::description) return {};
        if (!is_floating(values->values.type()) || flat) piece_.grid.points = in_space(values->values, axes);
        else piece_.grid.points = with_components(values->values, 3);
        return {};
    }
    static Array with_components(const Array& values, std::size_t components) {
        auto owner = std::make_shared<Array>(values);
        return Array(values.type(), values.data(), values.size() / components, components, owner);
    }
    static Array in_space(const Array& values, std::uint64_t axes) {
        std::vector<double> places(values.size() / axes * 3, 0.0);
        for (std::size_t i = 0; i < values.size(); ++i) places[i / axes * 3 + i % axes] = values.at(i);
        return Array::own(std::move(places), 3);
    }

    Result<void> read_cells(pugi::xml_node topology) {
        const std::string_view type = attribute(topology, "TopologyType", "Type");
        const std::string_view stated = attribute(topology, "NumberOfElements", "Dimensions");
        std::uint64_t count = 0;
        const bool counted = parse_number(stated, count);
        auto values = data_.read(topology.child("DataItem"), depth_);
        if (!values) return values.error();
        if (depth_ == Depth::arrays && topology.attribute("BaseOffset").as_llong() != 0)
            return broken(path_, "a topology with a BaseOffset is not read");
        if (same_word(type, "Mixed")) {
            if (!counted) return broken(path_, "a mixed topology does not state its NumberOfElements");
            cells_ = count;
            return depth_ == Depth::description ? Result<void>() : mixed_cells(values->values, count);
        }
        const Element* element = nullptr;
        for (const Element& known : elements)
            if (same_word(known.name, type)) element = &known;
        if (!element) return broken(path_, fmt::format("topology of type \"{}\" is not read", escaped(type)));
        const std::uint64_t corners =
            element->corners != 0 ? element->corners : topology.attribute("NodesPerElement").as_uint();
        if (corners == 0 || values->count() % corners != 0)
            return broken(path_, fmt::format("{} corners of cells are no multiple of {}", values->count(), corners));
        cells_ = values->count() / corners;
        if (counted && count != cells_)
            return broken(path_, fmt::format("{} elements are stated, {} are there", count, cells_));
        if (depth_ == Depth::arrays) uniform_cells(*element, corners, values->values);
        return {};
    }
    void uniform_cells(const Element& element, std::uint64_t corners, const Array& values) {
        Cells& cells = piece_.grid.cells;
        cells.connectivity = as_indices(values);
        if (element.type >= 10 && element.type <= 14) {
            cells.uniform_type = static_cast<CellType>(element.type);
            return;
        }
        std::vector<std::int64_t> offsets(cells_ + 1);
        for (std::uint64_t i = 0; i <= cells_; ++i) offsets[i] = static_cast<std::int64_t>(i * corners);
        cells.offsets = Array::own(std::move(offsets));
        cells.types = Array::own(std::vector<std::uint8_t>(cells_, element.type));
    }
    /// Some writers store indices as floating-point numbers, others in 8 or 16 bits.
    static Array as_indices(const Array& values) {
        if (!is_floating(values.type()) && size_of(values.type()) >= 4) return values;
        std::vector<std::int64_t> indices(values.size());
        values.visit([&](auto from) {
            for (std::size_t i = 0; i < from.size(); ++i) {
                const auto value = static_cast<double>(from[i]);
                indices[i] =
                    value >= 0 && value < 9e15 && value == static_cast<double>(static_cast<std::int64_t>(value))
                        ? static_cast<std::int64_t>(value)
                        : -1;
            }
        });
        return Array::own(std::move(indices));
    }
    /// Code of the cell type, for some types the number of corners, then the corners.
    Result<void> mixed_cells(const Array& values, std::uint64_t count) {
        if (count > values.size())
            return broken(path_,
                          fmt::format("{} mixed elements are stated, but there are {} numbers", count, values.size()));
        const Array indices = as_indices(values);
        std::vector<std::int64_t> connectivity, offsets{0};
        std::vector<std::uint8_t> types;
        return indices.visit([&](auto numbers) -> Result<void> {
            std::size_t at = 0;
            for (std::uint64_t cell = 0; cell < count; ++cell) {
                const Element* element = nullptr;
                for (const Element& known : elements)
                    if (at < numbers.size() && static_cast<std::int64_t>(numbers[at]) == known.code) element = &known;
                if (!element)
                    return broken(path_,
                                  fmt::format("element {} of a mixed topology, at number {}, has no type that is known",
                                              cell, at));
                ++at;
                std::uint64_t corners = element->corners;
                if (corners == 0 && at < numbers.size()) corners = static_cast<std::uint64_t>(numbers[at++]);
                if (corners > numbers.size() - at)
                    return broken(path_,
                                  fmt::format("element {} of a mixed topology ends after its last number", cell));
                for (std::uint64_t c = 0; c < corners; ++c)
                    connectivity.push_back(static_cast<std::int64_t>(numbers[at++]));
                offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
                types.push_back(element->type);
            }
            Cells& cells = piece_.grid.cells;
            cells.connectivity = Array::own(std::move(connectivity));
            cells.offsets = Array::own(std::move(offsets));
            cells.types = Array::own(std::move(types));
            return {};
        });
    }

    Result<void> read_field(pugi::xml_node field) {
        const std::string field_name = field.attribute("Name").as_string();
        const std::string_view center = field.attribute("Center").as_string("Node");
        const bool on_points = same_word(center, "Node");
        if (!on_points && !same_word(center, "Cell")) return {}; // of the whole grid, of faces, of edges
        const Association association = on_points ? Association::point : Association::cell;
        const std::uint64_t tuples = on_points ? points_ : cells_;
        const bool want = depth_ == Depth::arrays && wanted(options_, association, field_name);
        auto values = data_.read(field.child("DataItem"), want ? Depth::arrays : Depth::description);
        if (!values) return values.error();
        if (tuples == 0 || values->count() % tuples != 0 || values->count() == 0)
            return tuples == 0 ? Result<void>()
                               : Result<void>(broken(path_, fmt::format("attribute \"{}\" has {} values for {} {}",
                                                                        escaped(field_name), values->count(), tuples,
                                                                        on_points ? "points" : "cells")));
        const std::uint64_t components = values->count() / tuples;
        announce(loaded_.info, {field_name, association, values->values.type(), components});
        if (!want) return {};
        auto& fields = on_points ? piece_.grid.point_fields : piece_.grid.cell_fields;
        fields.push_back({field_name, with_components(values->values, components)});
        return {};
    }

    const std::string& path_;
    const XdmfDocument& document_;
    XdmfData data_;
    const ReadOptions& options_;
    Depth depth_;
    Loaded& loaded_;
    Piece piece_;
    std::uint64_t points_ = 0, cells_ = 0;
};

} // namespace

Result<Loaded> load_xdmf(const std::string& path, const ReadOptions& options, Depth depth) {
    auto document = XdmfDocument::open(path);
    if (!document) return document.error();
    Loaded loaded;
    for (const XdmfStep& step : document->steps())
        if (step.has_time) loaded.info.times.push_back(step.time);
    if (loaded.info.times.size() != document->steps().size()) loaded.info.times.clear();
    auto step = choose_step(loaded.info, depth == Depth::arrays ? options : ReadOptions());
    if (!step) return step.error();
    loaded.step = *step;
    const auto& grids = document->steps()[loaded.step].grids;
    for (std::size_t i = 0; i < grids.size(); ++i) {
        GridLoader grid(path, *document, options, depth, loaded);
        if (auto read = grid.load(grids[i]); !read) return read.error();
        report_progress(static_cast<double>(i + 1) / static_cast<double>(grids.size()));
    }
    if (depth == Depth::arrays && loaded.pieces.empty()) return broken(path, "its time step has no grid");
    return loaded;
}

} // namespace isotet::io::vtk
