// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/cgns/cgns_elements.hpp"

#include <vector>

#include "grid/cell/node_order.hpp"

namespace isotet::io::confined {
namespace {

using core::CellKind;

/// Elements with the nodes of all edges, faces and of the inside, or only with the first of these.
std::span<const std::uint16_t> order_of(CellKind kind, unsigned degree, std::uint32_t nodes) {
    static std::vector<std::vector<std::uint16_t>>& kept = *new std::vector<std::vector<std::uint16_t>>;
    std::vector<std::uint16_t>& order = kept.emplace_back(core::positions_in(core::NodeOrder::cgns, kind, degree));
    order.resize(nodes);
    return order;
}

std::vector<CgnsElement> all_elements() {
    constexpr auto tet = CellKind::tetrahedron, hexahedron = CellKind::hexahedron, wedge = CellKind::wedge,
                   pyramid = CellKind::pyramid;
    std::vector<CgnsElement> all(57);
    const auto flat = [&](std::size_t number, std::string_view name, int dimension, std::uint32_t nodes,
                          std::uint8_t type) {
        all[number] = {name, dimension, nodes, type, {}};
    };
    const auto solid = [&](std::size_t number, std::string_view name, std::uint32_t nodes, std::uint8_t type,
                           CellKind kind, unsigned degree) {
        all[number] = {name, 3, nodes, type, degree > 1 ? order_of(kind, degree, nodes) : std::span<std::uint16_t>()};
    };
    const auto unread = [&](std::size_t number, std::string_view name, std::uint32_t nodes) {
        all[number] = {name, 3, nodes, 0, {}};
    };
    flat(2, "NODE", 0, 1, 1);
    flat(3, "BAR_2", 1, 2, 3);
    flat(4, "BAR_3", 1, 3, 21);
    flat(5, "TRI_3", 2, 3, 5);
    flat(6, "TRI_6", 2, 6, 22);
    flat(7, "QUAD_4", 2, 4, 9);
    flat(8, "QUAD_8", 2, 8, 23);
    flat(9, "QUAD_9", 2, 9, 28);
    solid(10, "TETRA_4", 4, 10, tet, 1);
    solid(11, "TETRA_10", 10, 24, tet, 2);
    solid(12, "PYRA_5", 5, 14, pyramid, 1);
    solid(13, "PYRA_14", 14, 74, pyramid, 2);
    solid(14, "PENTA_6", 6, 13, wedge, 1);
    solid(15, "PENTA_15", 15, 26, wedge, 2);
    solid(16, "PENTA_18", 18, 32, wedge, 2);
    solid(17, "HEXA_8", 8, 12, hexahedron, 1);
    solid(18, "HEXA_20", 20, 25, hexahedron, 2);
    solid(19, "HEXA_27", 27, 29, hexahedron, 2);
    solid(21, "PYRA_13", 13, 27, pyramid, 2);
    flat(24, "BAR_4", 1, 4, 68);
    flat(25, "TRI_9", 2, 9, 0);
    flat(26, "TRI_10", 2, 10, 69);
    flat(27, "QUAD_12", 2, 12, 0);
    flat(28, "QUAD_16", 2, 16, 70);
    unread(29, "TETRA_16", 16);
    solid(30, "TETRA_20", 20, 71, tet, 3);
    unread(31, "PYRA_21", 21);
    unread(32, "PYRA_29", 29);
    solid(33, "PYRA_30", 30, 74, pyramid, 3);
    unread(34, "PENTA_24", 24);
    unread(35, "PENTA_38", 38);
    solid(36, "PENTA_40", 40, 73, wedge, 3);
    unread(37, "HEXA_32", 32);
    unread(38, "HEXA_56", 56);
    solid(39, "HEXA_64", 64, 72, hexahedron, 3);
    flat(40, "BAR_5", 1, 5, 68);
    flat(41, "TRI_12", 2, 12, 0);
    flat(42, "TRI_15", 2, 15, 69);
    flat(43, "QUAD_P4_16", 2, 16, 0);
    flat(44, "QUAD_25", 2, 25, 70);
    unread(45, "TETRA_22", 22);
    unread(46, "TETRA_34", 34);
    solid(47, "TETRA_35", 35, 71, tet, 4);
    unread(48, "PYRA_P4_29", 29);
    unread(49, "PYRA_50", 50);
    solid(50, "PYRA_55", 55, 74, pyramid, 4);
    unread(51, "PENTA_33", 33);
    unread(52, "PENTA_66", 66);
    solid(53, "PENTA_75", 75, 73, wedge, 4);
    unread(54, "HEXA_44", 44);
    unread(55, "HEXA_98", 98);
    solid(56, "HEXA_125", 125, 72, hexahedron, 4);
    return all;
}

} // namespace

const CgnsElement* cgns_element(std::int64_t number) {
    static const std::vector<CgnsElement>& all = *new std::vector<CgnsElement>(all_elements());
    if (number < 0 || number >= static_cast<std::int64_t>(all.size())) return nullptr;
    const CgnsElement& element = all[static_cast<std::size_t>(number)];
    return element.nodes == 0 ? nullptr : &element;
}

} // namespace isotet::io::confined
