// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Gmsh's element types, and the order of their nodes.
#include <algorithm>
#include <array>
#include <map>

#include "grid/cell/node_order.hpp"
#include "io/gmsh/read_gmsh_parts.hpp"

namespace isotet::io::gmsh {

namespace {

/// Types whose nodes stand in another order than VTK's.
struct ReorderedType {
    std::int32_t number;
    core::CellKind kind;
    unsigned degree;
    std::size_t nodes; ///< the first so many of all of that degree: those without nodes inside faces have fewer
};

std::vector<ReorderedType> reordered_types() {
    using enum core::CellKind;
    std::vector<ReorderedType> out{{17, hexahedron, 2, 20}, {18, wedge, 2, 15}, {19, pyramid, 2, 13}};
    const auto add = [&](std::int32_t number, core::CellKind kind, unsigned degree) {
        out.push_back({number, kind, degree, core::node_count(kind, degree)});
    };
    add(11, tetrahedron, 2);
    for (int i = 0; i < 3; ++i) add(29 + i, tetrahedron, 3 + static_cast<unsigned>(i));
    for (int i = 0; i < 5; ++i) add(71 + i, tetrahedron, 6 + static_cast<unsigned>(i));
    add(13, wedge, 2);
    add(90, wedge, 3);
    add(91, wedge, 4);
    for (int i = 0; i < 5; ++i) add(106 + i, wedge, 5 + static_cast<unsigned>(i));
    add(12, hexahedron, 2);
    for (int i = 0; i < 7; ++i) add(92 + i, hexahedron, 3 + static_cast<unsigned>(i));
    add(14, pyramid, 2);
    for (int i = 0; i < 7; ++i) add(118 + i, pyramid, 3 + static_cast<unsigned>(i));
    return out;
}

/// For each node in VTK's order its position in Gmsh's.
std::vector<std::uint16_t> order_of(const ReorderedType& type) {
    std::vector<std::uint16_t> out = core::positions_in(core::NodeOrder::gmsh, type.kind, type.degree);
    out.resize(type.nodes);
    return out;
}

std::span<const std::uint16_t> node_order(std::int32_t number) {
    static const std::map<std::int32_t, std::vector<std::uint16_t>> orders = [] {
        std::map<std::int32_t, std::vector<std::uint16_t>> made;
        for (const ReorderedType& type : reordered_types()) made[type.number] = order_of(type);
        return made;
    }();
    const auto found = orders.find(number);
    return found == orders.end() ? std::span<const std::uint16_t>() : found->second;
}

} // namespace

std::optional<ElementType> element_type(std::int32_t number) {
    struct Row {
        std::int32_t number;
        std::uint8_t vtk_type;
        std::uint32_t nodes;
    };
    // Gmsh's number; VTK's number (68 to 74: Lagrange cells of any order) and nodes.
    static constexpr Row rows[] = {
        {1, 3, 2},      {2, 5, 3},      {3, 9, 4},      {4, 10, 4},     {5, 12, 8},     {6, 13, 6},    {7, 14, 5},
        {8, 21, 3},     {9, 22, 6},     {10, 28, 9},    {11, 24, 10},   {12, 29, 27},   {13, 32, 18},  {14, 74, 14},
        {15, 1, 1},     {16, 23, 8},    {17, 25, 20},   {18, 26, 15},   {19, 27, 13},   {20, 69, 9},   {21, 69, 10},
        {22, 69, 12},   {23, 69, 15},   {24, 69, 15},   {25, 69, 21},   {26, 68, 4},    {27, 68, 5},   {28, 68, 6},
        {29, 71, 20},   {30, 71, 35},   {31, 71, 56},   {36, 70, 16},   {37, 70, 25},   {38, 70, 36},  {42, 69, 28},
        {43, 69, 36},   {44, 69, 45},   {45, 69, 55},   {46, 69, 66},   {47, 70, 49},   {48, 70, 64},  {49, 70, 81},
        {50, 70, 100},  {51, 70, 121},  {62, 68, 7},    {63, 68, 8},    {64, 68, 9},    {65, 68, 10},  {66, 68, 11},
        {71, 71, 84},   {72, 71, 120},  {73, 71, 165},  {74, 71, 220},  {75, 71, 286},  {90, 73, 40},  {91, 73, 75},
        {92, 72, 64},   {93, 72, 125},  {94, 72, 216},  {95, 72, 343},  {96, 72, 512},  {97, 72, 729}, {98, 72, 1000},
        {106, 73, 126}, {107, 73, 196}, {108, 73, 288}, {109, 73, 405}, {110, 73, 550}, {118, 74, 30}, {119, 74, 55},
        {120, 74, 91},  {121, 74, 140}, {122, 74, 204}, {123, 74, 285}, {124, 74, 385},
    };
    const auto found =
        std::find_if(std::begin(rows), std::end(rows), [&](const Row& row) { return row.number == number; });
    if (found == std::end(rows)) return std::nullopt;
    return ElementType{found->vtk_type, found->nodes, node_order(number)};
}

} // namespace isotet::io::gmsh
