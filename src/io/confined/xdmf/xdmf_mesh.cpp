// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/xdmf/xdmf_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "io/confined/xdmf/xdmf_cells.hpp"
#include "io/files/escape.hpp"
#include "io/files/text_scanner.hpp"
#include "io/pieces/loaded.hpp"
#include "io/vtk_xml/load.hpp"

namespace isotet::io::confined {
namespace {

using vtk_xml::GridSize;

std::string_view type_of_topology(pugi::xml_node topology) { return attribute_of(topology, "TopologyType", "Type"); }

bool is_structured(std::string_view type) {
    return std::ranges::any_of(std::array{"3DSMesh", "3DRectMesh", "3DCoRectMesh"},
                               [&](const char* name) { return same_word(type, name); });
}

/// Of elements: "27", "3 3 3", or with the nodes of each, "27 8".
std::optional<std::vector<std::uint64_t>> stated_counts(pugi::xml_node topology) {
    return whole_numbers(attribute_of(topology, "NumberOfElements", "Dimensions"));
}

std::uint64_t product_of(const std::vector<std::uint64_t>& counts) {
    std::uint64_t product = 1;
    for (const std::uint64_t count : counts) product *= count;
    return product;
}

Array in_tuples(const Array& values, std::size_t components) {
    auto owner = std::make_shared<Array>(values);
    return Array(values.type(), values.data(), values.size() / components, components, owner);
}

Array as_doubles(const std::vector<Array>& columns) {
    std::vector<double> places(columns.front().size() * 3, 0.0);
    for (std::size_t axis = 0; axis < columns.size(); ++axis)
        for (std::size_t i = 0; i < columns[axis].size(); ++i) places[3 * i + axis] = columns[axis].at(i);
    return Array::own(std::move(places), 3);
}

Array in_space(const Array& values, std::uint64_t axes) {
    if (axes == 3 && is_floating(values.type())) return in_tuples(values, 3);
    std::vector<double> places(values.size() / axes * 3, 0.0);
    for (std::size_t i = 0; i < values.size(); ++i) places[i / axes * 3 + i % axes] = values.at(i);
    return Array::own(std::move(places), 3);
}

std::vector<double> doubles(const Array& values) {
    std::vector<double> out(values.size());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = values.at(i);
    return out;
}

/// Nothing where some are not evenly spaced.
std::optional<XdmfImage> image_of(const std::array<std::vector<double>, 3>& ticks) {
    constexpr double uneven = 1e-4; // of a cell
    XdmfImage image;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::vector<double>& along = ticks[axis];
        if (along.size() < 2) return std::nullopt;
        const double spacing = (along.back() - along.front()) / static_cast<double>(along.size() - 1);
        for (std::size_t i = 0; i < along.size(); ++i)
            if (!(std::abs(along[i] - along.front() - static_cast<double>(i) * spacing) <= uneven * spacing))
                return std::nullopt;
        image.origin[axis] = along.front();
        image.spacing[axis] = spacing;
        image.cells[axis] = along.size() - 1;
    }
    return image;
}

class MeshReader {
public:
    MeshReader(const XdmfFile& file, pugi::xml_node geometry, pugi::xml_node topology, Depth depth,
               std::vector<std::string>& notes)
        : file_(file), geometry_(geometry), topology_(topology), depth_(depth), notes_(notes) {}

    Result<XdmfMesh> read() {
        const std::string_view type = type_of_topology(topology_);
        if (is_structured(type))
            if (auto sized = find_size(); !sized) return sized.error();
        if (auto points = read_points(); !points) return points.error();
        if (size_ && mesh_.points != points_of_size())
            return wrong(
                fmt::format("a topology of {} x {} x {} points has {}", size_->x, size_->y, size_->z, mesh_.points));
        if (auto cells = size_ ? structured_cells() : read_cells(type); !cells) return cells.error();
        return std::move(mesh_);
    }

private:
    Error wrong(std::string_view what) const { return broken(file_.document.file_of(topology_), what); }

    /// Of structured topologies, slowest axis first.
    Result<void> find_size() {
        const auto stated = whole_numbers(attribute_of(topology_, "Dimensions", "NumberOfElements"));
        if (!stated || stated->size() != 3 ||
            std::ranges::any_of(*stated, [](std::uint64_t n) { return n == 0 || n > (1U << 20U); }))
            return wrong(fmt::format("a topology of type \"{}\" has Dimensions \"{}\", which are no three numbers of "
                                     "points up to 1,048,576",
                                     escaped(type_of_topology(topology_)),
                                     escaped(attribute_of(topology_, "Dimensions", "NumberOfElements"))));
        size_ = GridSize{(*stated)[2], (*stated)[1], (*stated)[0]};
        return {};
    }
    std::uint64_t points_of_size() const { return size_->x * size_->y * size_->z; }

    Result<void> read_points() {
        const std::string_view type = attribute_of(geometry_, "GeometryType", "Type");
        if (type.empty() || same_word(type, "XYZ")) return interlaced(3);
        if (same_word(type, "XY")) return interlaced(2);
        if (same_word(type, "X_Y_Z")) return separate(3);
        if (same_word(type, "X_Y")) return separate(2);
        if (same_word(type, "VXVYVZ") && size_) return along_axes();
        if (same_word(type, "ORIGIN_DXDYDZ") && size_) return from_origin();
        return wrong(
            fmt::format("geometry of type \"{}\" with a topology of type \"{}\" is not read: XYZ, XY, X_Y_Z and "
                        "X_Y are, VXVYVZ and ORIGIN_DXDYDZ with structured topologies",
                        escaped(type), escaped(type_of_topology(topology_))));
    }
    Result<void> interlaced(std::uint64_t axes) {
        auto values = file_.data.read(file_.document.child(geometry_, "DataItem"), depth_);
        if (!values) return values.error();
        if (values->count() % axes != 0)
            return wrong(fmt::format("{} coordinates are no multiple of {}", values->count(), axes));
        mesh_.points = values->count() / axes;
        if (values->values.type() == ScalarType::float64) mesh_.coordinates = ScalarType::float64;
        if (depth_ == Depth::arrays) mesh_.grid.points = in_space(values->values, axes);
        return {};
    }
    /// The DataItems of the geometry; read whole even for a description where `depth` says so.
    Result<std::vector<ShapedValues>> columns(std::size_t count, Depth depth) const {
        const auto items = file_.document.children(geometry_, "DataItem");
        if (items.size() != count)
            return wrong(fmt::format("a geometry of type \"{}\" has {} DataItems, but needs {}",
                                     escaped(attribute_of(geometry_, "GeometryType", "Type")), items.size(), count));
        std::vector<ShapedValues> all;
        for (const pugi::xml_node item : items) {
            auto values = file_.data.read(item, depth);
            if (!values) return values.error();
            all.push_back(*std::move(values));
        }
        return all;
    }
    Result<void> separate(std::size_t axes) {
        const auto all = columns(axes, depth_);
        if (!all) return all.error();
        std::vector<Array> values;
        for (const ShapedValues& column : *all) {
            if (column.count() != all->front().count())
                return wrong(fmt::format("there are {} and {} coordinates of points along different axes",
                                         all->front().count(), column.count()));
            values.push_back(column.values);
        }
        mesh_.points = all->front().count();
        if (depth_ == Depth::arrays) mesh_.grid.points = as_doubles(values);
        return {};
    }
    Result<void> along_axes() {
        const auto all = columns(3, Depth::arrays);
        if (!all) return all.error();
        const std::array<std::uint64_t, 3> size{size_->x, size_->y, size_->z};
        std::array<std::vector<double>, 3> ticks;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if ((*all)[axis].count() != size[axis])
                return wrong(
                    fmt::format("axis {} has {} coordinates for {} points", axis, (*all)[axis].count(), size[axis]));
            ticks[axis] = doubles((*all)[axis].values);
        }
        mesh_.points = points_of_size();
        mesh_.image = image_of(ticks);
        return take_points([&] { return vtk_xml::points_of(*size_, ticks); });
    }
    /// Origin and spacing, slowest axis first.
    Result<void> from_origin() {
        const auto all = columns(2, Depth::arrays);
        if (!all) return all.error();
        for (const ShapedValues& three : *all)
            if (three.values.size() != 3)
                return wrong(fmt::format("origin or spacing has {} numbers, but needs 3", three.values.size()));
        vtk_xml::ImagePoints image;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            image.origin[axis] = (*all)[0].values.at(2 - axis);
            image.matrix[4 * axis] = (*all)[1].values.at(2 - axis);
        }
        mesh_.points = points_of_size();
        mesh_.image = XdmfImage{image.origin,
                                {image.matrix[0], image.matrix[4], image.matrix[8]},
                                {size_->x - 1, size_->y - 1, size_->z - 1}};
        return take_points([&] { return vtk_xml::points_of(*size_, image); });
    }
    template <class Make>
    Result<void> take_points(const Make& make) {
        if (depth_ == Depth::description) return {};
        auto points = make();
        if (!points) return points.error();
        mesh_.grid.points = *std::move(points);
        return {};
    }

    Result<void> structured_cells() {
        mesh_.cells = vtk_xml::cells_in_box(*size_);
        if (depth_ == Depth::description) return {};
        auto cells = vtk_xml::cells_of_box(*size_, notes_);
        if (!cells) return cells.error();
        mesh_.grid.cells = *std::move(cells);
        return {};
    }

    Result<void> read_cells(std::string_view type) {
        const XdmfElement* const element = xdmf_element(type);
        const bool mixed = same_word(type, "Mixed");
        if (!mixed && !element) return wrong(fmt::format("topology of type \"{}\" is not read", escaped(type)));
        const auto stated = stated_counts(topology_);
        const std::optional<std::uint64_t> count = stated ? std::optional(product_of(*stated)) : std::nullopt;
        const bool listed = mixed || element->type == xdmf_polyhedron;
        const bool must_count = listed && !count; // only the numbers tell
        auto values =
            file_.data.read_indices(file_.document.child(topology_, "DataItem"), must_count ? Depth::arrays : depth_);
        if (!values) return values.error();
        if (!listed) return uniform_cells(*element, stated, *values);
        if (count) mesh_.cells = *count;
        if (depth_ == Depth::description && !must_count) return {};
        const std::int64_t base = topology_.attribute("BaseOffset").as_llong();
        auto cells = mixed ? mixed_elements(values->values, count, mesh_.points, base)
                           : polyhedral_elements(values->values, count, mesh_.points, base);
        return take_cells_of(std::move(cells));
    }
    Result<void> uniform_cells(const XdmfElement& element, const std::optional<std::vector<std::uint64_t>>& stated,
                               const ShapedValues& values) {
        const std::uint64_t usual = element.type == 2 ? 1 : element.type == 4 ? 2 : 0; // vertices, lines
        const std::uint64_t corners =
            element.corners != 0 ? element.corners
                                 : topology_.attribute("NodesPerElement").as_uint(static_cast<unsigned>(usual));
        if (corners == 0 || values.count() % corners != 0)
            return wrong(fmt::format("{} corners of cells are no multiple of {}", values.count(), corners));
        mesh_.cells = values.count() / corners;
        mesh_.corners = values.count();
        if (stated && stated->front() != mesh_.cells && product_of(*stated) != mesh_.cells)
            return wrong(fmt::format("{} elements are stated, {} are there", product_of(*stated), mesh_.cells));
        if (depth_ == Depth::description) return {};
        const auto order = whole_numbers(topology_.attribute("Order").as_string());
        return take_cells_of(uniform_elements(element, corners, values.values,
                                              topology_.attribute("BaseOffset").as_llong(),
                                              order.value_or(std::vector<std::uint64_t>())));
    }
    Result<void> take_cells_of(Result<Cells> cells) {
        if (!cells) return cells.error().code == ErrorCode::invalid_data ? wrong(cells.error().message) : cells.error();
        mesh_.cells = cells->count();
        if (depth_ == Depth::arrays) mesh_.grid.cells = *std::move(cells);
        return {};
    }

    const XdmfFile& file_;
    pugi::xml_node geometry_, topology_;
    Depth depth_;
    std::vector<std::string>& notes_;
    std::optional<GridSize> size_;
    XdmfMesh mesh_;
};

} // namespace

std::string_view attribute_of(pugi::xml_node node, const char* name, const char* older_name) {
    const pugi::xml_attribute stated = node.attribute(name);
    return stated ? stated.as_string() : node.attribute(older_name).as_string();
}

Result<XdmfMesh> read_mesh(const XdmfFile& file, pugi::xml_node geometry, pugi::xml_node topology, Depth depth,
                           std::vector<std::string>& notes) {
    return MeshReader(file, geometry, topology, depth, notes).read();
}

bool is_flat(pugi::xml_node topology) {
    const std::string_view type = type_of_topology(topology);
    const XdmfElement* const element = xdmf_element(type);
    if (element) return element->type < 10 || (element->type >= 21 && element->type <= 23) || element->type == 28;
    return std::ranges::any_of(std::array{"2DSMesh", "2DRectMesh", "2DCoRectMesh"},
                               [&](const char* name) { return same_word(type, name); });
}

} // namespace isotet::io::confined
