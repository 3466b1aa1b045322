// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/ensight/ensight_cells.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "io/pieces/uniform_cells.hpp"

namespace isotet::io::confined {
namespace {

/// EnSight goes around the base of a wedge the other way than VTK. Each of these is its own inverse.
constexpr std::array<std::uint8_t, 3> ensight_bar{0, 2, 1};
constexpr std::array<std::uint8_t, 15> ensight_wedge{0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13};

/// Of any number that a file may hold.
std::int32_t from_one_to_zero(std::int32_t number) {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(number) - 1);
}

} // namespace

const EnsightElement* ensight_element(std::string_view name) {
    static constexpr std::array elements{
        EnsightElement{"point", 1, 1},      EnsightElement{"bar2", 3, 2},
        EnsightElement{"bar3", 21, 3, ensight_bar}, EnsightElement{"tria3", 5, 3},
        EnsightElement{"tria6", 22, 6},     EnsightElement{"quad4", 9, 4},
        EnsightElement{"quad8", 23, 8},     EnsightElement{"tetra4", 10, 4},
        EnsightElement{"tetra10", 24, 10},  EnsightElement{"pyramid5", 14, 5},
        EnsightElement{"pyramid13", 27, 13}, EnsightElement{"penta6", 13, 6, std::span(ensight_wedge).first(6)},
        EnsightElement{"penta15", 26, 15, ensight_wedge}, EnsightElement{"hexa8", 12, 8},
        EnsightElement{"hexa20", 25, 20},   EnsightElement{"nsided", ensight_polygon},
        EnsightElement{"nfaced", ensight_polyhedron}};
    const auto* const found = std::ranges::find(elements, name, &EnsightElement::name);
    return found == elements.end() ? nullptr : found;
}

void EnsightCells::append(std::vector<std::int32_t> nodes) {
    for (std::int32_t& node : nodes) node = from_one_to_zero(node);
    if (connectivity_.empty()) connectivity_ = std::move(nodes);
    else connectivity_.insert(connectivity_.end(), nodes.begin(), nodes.end());
}

void EnsightCells::end_cell(std::uint8_t type, std::int64_t end) {
    types_.push_back(type);
    offsets_.push_back(end);
}

void EnsightCells::add(const EnsightElement& element, std::vector<std::int32_t> nodes) {
    const std::size_t width = element.nodes, count = nodes.size() / width;
    std::vector<std::int32_t> row(element.order.size());
    if (!row.empty())
        for (std::size_t at = 0; at < nodes.size(); at += width) {
            for (std::size_t i = 0; i < width; ++i) row[i] = nodes[at + element.order[i]];
            std::ranges::copy(row, nodes.begin() + static_cast<std::ptrdiff_t>(at));
        }
    append(std::move(nodes));
    types_.insert(types_.end(), count, element.vtk_type);
    for (std::size_t i = 0; i < count; ++i) offsets_.push_back(offsets_.back() + static_cast<std::int64_t>(width));
}

void EnsightCells::add_polygons(std::span<const std::int32_t> sizes, std::vector<std::int32_t> nodes) {
    append(std::move(nodes));
    for (const std::int32_t size : sizes) end_cell(ensight_polygon, offsets_.back() + size);
}

void EnsightCells::add_polyhedra(std::span<const std::int32_t> faces, std::span<const std::int32_t> sizes,
                                 std::span<const std::int32_t> nodes, std::uint64_t points) {
    std::vector<std::uint64_t> last_cell(points); // from 1, that has a point
    face_offsets_.resize(offsets_.size(), static_cast<std::int64_t>(faces_.size()));
    std::size_t face = 0, at = 0;
    for (const std::int32_t faces_of_cell : faces) {
        faces_.push_back(faces_of_cell);
        for (std::int32_t i = 0; i < faces_of_cell; ++i, ++face) {
            faces_.push_back(sizes[face]);
            for (std::int32_t j = 0; j < sizes[face]; ++j, ++at) {
                const std::int32_t point = faces_.emplace_back(from_one_to_zero(nodes[at]));
                if (static_cast<std::uint32_t>(point) < points &&
                    std::exchange(last_cell[static_cast<std::size_t>(point)], count() + 1) != count() + 1)
                    connectivity_.push_back(point);
            }
        }
        end_cell(ensight_polyhedron, static_cast<std::int64_t>(connectivity_.size()));
        face_offsets_.push_back(static_cast<std::int64_t>(faces_.size()));
    }
}

Cells EnsightCells::take() && {
    Cells cells;
    if (!faces_.empty()) {
        face_offsets_.resize(offsets_.size(), static_cast<std::int64_t>(faces_.size()));
        cells.faces = Array::own(std::move(faces_));
        cells.face_offsets = Array::own(std::move(face_offsets_));
    }
    if (types_.empty()) return cells;
    cells.connectivity = Array::own(std::move(connectivity_));
    cells.offsets = Array::own(std::move(offsets_));
    cells.types = Array::own(std::move(types_));
    vtk_xml::simplify(cells);
    return cells;
}

} // namespace isotet::io::confined
