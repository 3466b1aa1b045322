// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/cell/node_order.hpp"

#include <map>
#include <span>

namespace isotet::core {

namespace {

using SchemeEdge = std::array<std::uint8_t, 2>;
/// Corners of a face: inside, the first number goes from the first corner to the second, the other to the last.
struct SchemeFace {
    std::uint8_t count;
    std::array<std::uint8_t, 4> corners;
};

/// How the inside of a face is listed: row by row; as a smaller cell, corners first; or once around, and inwards.
enum class Listing : std::uint8_t { rows, nested, around };

/// How a program lists the nodes of a kind: corners, the edges' inside, the faces' inside, the cell's inside.
struct NodeScheme {
    std::span<const SchemeEdge> edges;
    std::span<const SchemeFace> faces;
    Listing triangles, squares;
};

constexpr std::array<SchemeEdge, 6> vtk_tet_edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
constexpr std::array<SchemeFace, 4> vtk_tet_faces{{{3, {0, 1, 3}}, {3, {2, 3, 1}}, {3, {0, 3, 2}}, {3, {0, 2, 1}}}};
constexpr std::array<SchemeEdge, 9> vtk_wedge_edges{
    {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}};
constexpr std::array<SchemeFace, 5> vtk_wedge_faces{
    {{3, {0, 1, 2}}, {3, {3, 4, 5}}, {4, {0, 1, 4, 3}}, {4, {1, 2, 5, 4}}, {4, {2, 0, 3, 5}}}};
constexpr std::array<SchemeEdge, 12> vtk_hexahedron_edges{
    {{0, 1}, {1, 2}, {3, 2}, {0, 3}, {4, 5}, {5, 6}, {7, 6}, {4, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};
constexpr std::array<SchemeFace, 6> vtk_hexahedron_faces{
    {{4, {0, 3, 7, 4}}, {4, {1, 2, 6, 5}}, {4, {0, 1, 5, 4}}, {4, {3, 2, 6, 7}}, {4, {0, 1, 2, 3}}, {4, {4, 5, 6, 7}}}};
constexpr std::array<SchemeEdge, 8> vtk_pyramid_edges{{{0, 1}, {1, 2}, {3, 2}, {0, 3}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}};
constexpr std::array<SchemeFace, 5> vtk_pyramid_faces{
    {{4, {0, 1, 2, 3}}, {3, {0, 1, 4}}, {3, {1, 2, 4}}, {3, {2, 3, 4}}, {3, {3, 0, 4}}}};
constexpr std::array<SchemeEdge, 6> gmsh_tet_edges{{{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}}};
constexpr std::array<SchemeFace, 4> gmsh_tet_faces{{{3, {0, 2, 1}}, {3, {0, 1, 3}}, {3, {0, 3, 2}}, {3, {3, 1, 2}}}};
constexpr std::array<SchemeEdge, 9> gmsh_wedge_edges{
    {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}}};
constexpr std::array<SchemeFace, 5> gmsh_wedge_faces{
    {{3, {0, 2, 1}}, {3, {3, 4, 5}}, {4, {0, 1, 4, 3}}, {4, {0, 3, 5, 2}}, {4, {1, 2, 5, 4}}}};
constexpr std::array<SchemeEdge, 12> gmsh_hexahedron_edges{
    {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3}, {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}}};
constexpr std::array<SchemeFace, 6> gmsh_hexahedron_faces{
    {{4, {0, 3, 2, 1}}, {4, {0, 1, 5, 4}}, {4, {0, 4, 7, 3}}, {4, {1, 2, 6, 5}}, {4, {2, 3, 7, 6}}, {4, {4, 5, 6, 7}}}};
constexpr std::array<SchemeEdge, 8> gmsh_pyramid_edges{
    {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 4}, {2, 3}, {2, 4}, {3, 4}}};
constexpr std::array<SchemeFace, 5> gmsh_pyramid_faces{
    {{3, {0, 1, 4}}, {3, {3, 0, 4}}, {3, {1, 2, 4}}, {3, {2, 3, 4}}, {4, {0, 3, 2, 1}}}};

constexpr std::array<SchemeFace, 4> cgns_tet_faces{{{3, {0, 1, 2}}, {3, {0, 1, 3}}, {3, {1, 2, 3}}, {3, {2, 0, 3}}}};
constexpr std::array<SchemeEdge, 9> cgns_wedge_edges{
    {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 4}, {2, 5}, {3, 4}, {4, 5}, {5, 3}}};
constexpr std::array<SchemeFace, 5> cgns_wedge_faces{
    {{3, {0, 1, 2}}, {4, {0, 1, 4, 3}}, {4, {1, 2, 5, 4}}, {4, {2, 0, 3, 5}}, {3, {3, 4, 5}}}};
constexpr std::array<SchemeEdge, 12> cgns_hexahedron_edges{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 5}, {2, 6}, {3, 7}, {4, 5}, {5, 6}, {6, 7}, {7, 4}}};
constexpr std::array<SchemeFace, 6> cgns_hexahedron_faces{
    {{4, {0, 1, 2, 3}}, {4, {0, 1, 5, 4}}, {4, {1, 2, 6, 5}}, {4, {2, 3, 7, 6}}, {4, {3, 0, 4, 7}}, {4, {4, 5, 6, 7}}}};
constexpr std::array<SchemeEdge, 8> cgns_pyramid_edges{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}};

/// The standard of CGNS lists the nodes of cells of up to four edges a side.
NodeScheme scheme_of_cgns(CellKind kind) {
    using enum Listing;
    switch (kind) {
    case CellKind::tetrahedron: return {vtk_tet_edges, cgns_tet_faces, nested, around};
    case CellKind::wedge: return {cgns_wedge_edges, cgns_wedge_faces, nested, around};
    case CellKind::pyramid: return {cgns_pyramid_edges, vtk_pyramid_faces, nested, around};
    case CellKind::hexahedron: break;
    }
    return {cgns_hexahedron_edges, cgns_hexahedron_faces, nested, around};
}

NodeScheme scheme_of(CellKind kind, NodeOrder order) {
    if (order == NodeOrder::cgns) return scheme_of_cgns(kind);
    using enum Listing;
    const bool gmsh = order == NodeOrder::gmsh;
    switch (kind) {
    case CellKind::tetrahedron:
        if (gmsh) return {gmsh_tet_edges, gmsh_tet_faces, nested, nested};
        return {vtk_tet_edges, vtk_tet_faces, nested, nested};
    case CellKind::wedge:
        if (gmsh) return {gmsh_wedge_edges, gmsh_wedge_faces, nested, nested};
        return {vtk_wedge_edges, vtk_wedge_faces, rows, rows};
    case CellKind::pyramid:
        if (gmsh) return {gmsh_pyramid_edges, gmsh_pyramid_faces, nested, nested};
        return {vtk_pyramid_edges, vtk_pyramid_faces, nested, rows};
    case CellKind::hexahedron: break;
    }
    if (gmsh) return {gmsh_hexahedron_edges, gmsh_hexahedron_faces, nested, nested};
    return {vtk_hexahedron_edges, vtk_hexahedron_faces, rows, rows};
}

std::span<const LatticePlace> unit_corners(CellKind kind) {
    static constexpr std::array<LatticePlace, 4> tet{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    static constexpr std::array<LatticePlace, 5> pyramid{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}}};
    static constexpr std::array<LatticePlace, 6> wedge{
        {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}}};
    static constexpr std::array<LatticePlace, 8> hexahedron{
        {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}};
    if (kind == CellKind::tetrahedron) return tet;
    if (kind == CellKind::pyramid) return pyramid;
    if (kind == CellKind::wedge) return wedge;
    return hexahedron;
}

using FlatPlace = std::array<int, 2>;

/// A triangle of this degree (below 0: nothing); nested: corners, edges, then the inside likewise.
void add_triangle(int degree, Listing listing, int from, std::vector<FlatPlace>& out) {
    if (degree < 0) return;
    if (listing == Listing::rows || degree == 0) {
        for (int v = 0; v <= degree; ++v)
            for (int u = 0; u <= degree - v; ++u) out.push_back({from + u, from + v});
        return;
    }
    for (const auto& [u, v] : {FlatPlace{0, 0}, {degree, 0}, {0, degree}}) out.push_back({from + u, from + v});
    for (int i = 1; i < degree; ++i) out.push_back({from + i, from});
    for (int i = 1; i < degree; ++i) out.push_back({from + degree - i, from + i});
    for (int i = 1; i < degree; ++i) out.push_back({from, from + degree - i});
    add_triangle(degree - 3, listing, from + 1, out);
}

void add_square(int degree, Listing listing, int from, std::vector<FlatPlace>& out) {
    if (degree < 0) return;
    if (listing == Listing::rows || degree == 0) {
        for (int v = 0; v <= degree; ++v)
            for (int u = 0; u <= degree; ++u) out.push_back({from + u, from + v});
        return;
    }
    const bool corners_first = listing == Listing::nested;
    const std::array<FlatPlace, 4> corners{{{0, 0}, {degree, 0}, {degree, degree}, {0, degree}}};
    const auto add_corner = [&](std::size_t i) { out.push_back({from + corners[i][0], from + corners[i][1]}); };
    for (std::size_t i = 0; corners_first && i < corners.size(); ++i) add_corner(i);
    if (!corners_first) add_corner(0);
    for (int i = 1; i < degree; ++i) out.push_back({from + i, from});
    if (!corners_first) add_corner(1);
    for (int i = 1; i < degree; ++i) out.push_back({from + degree, from + i});
    if (!corners_first) add_corner(2);
    for (int i = 1; i < degree; ++i) out.push_back({from + degree - i, from + degree});
    if (!corners_first) add_corner(3);
    for (int i = 1; i < degree; ++i) out.push_back({from, from + degree - i});
    add_square(degree - 2, listing, from + 1, out);
}

LatticePlace place_at(int x, int y, int z) {
    return {static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), static_cast<std::uint16_t>(z)};
}

/// The cell's inside; its least numbers are `from`.
void add_inside(CellKind kind, int degree, NodeOrder order, std::vector<LatticePlace>& out) {
    if (kind == CellKind::wedge) {
        std::vector<FlatPlace> triangle;
        add_triangle(degree - 3, order == NodeOrder::vtk ? Listing::rows : Listing::nested, 1, triangle);
        std::vector<int> layers;
        for (int layer = 1; layer < degree; ++layer) layers.push_back(layer);
        if (order != NodeOrder::gmsh) {
            for (const int layer : layers)
                for (const auto& [u, v] : triangle) out.push_back(place_at(u, v, layer));
            return;
        }
        if (degree > 2) layers.insert(layers.begin() + 1, degree - 1), layers.pop_back();
        for (const auto& [u, v] : triangle)
            for (const int layer : layers) out.push_back(place_at(u, v, layer));
        return;
    }
    if (kind == CellKind::hexahedron && order == NodeOrder::vtk) {
        for (int z = 1; z < degree; ++z)
            for (int y = 1; y < degree; ++y)
                for (int x = 1; x < degree; ++x) out.push_back(place_at(x, y, z));
        return;
    }
    if (kind == CellKind::pyramid && order == NodeOrder::vtk) {
        for (int z = 1; z < degree; ++z)
            for (int y = 1; y < degree - z; ++y)
                for (int x = 1; x < degree - z; ++x) out.push_back(place_at(x, y, z));
        return;
    }
    if (kind == CellKind::hexahedron && order == NodeOrder::cgns) {
        std::vector<FlatPlace> square;
        add_square(degree - 2, Listing::around, 1, square);
        for (int z = 1; z < degree; ++z)
            for (const auto& [u, v] : square) out.push_back(place_at(u, v, z));
        return;
    }
    const int inside = degree - (kind == CellKind::tetrahedron ? 4 : kind == CellKind::pyramid ? 3 : 2);
    if (inside == 0) out.push_back({1, 1, 1});
    if (inside < 1) return;
    for (const LatticePlace& p : nodes_of_degree(kind, static_cast<unsigned>(inside), order))
        out.push_back(place_at(p[0] + 1, p[1] + 1, p[2] + 1));
}

} // namespace

std::vector<LatticePlace> nodes_of_degree(CellKind kind, unsigned degree, NodeOrder order) {
    const NodeScheme scheme = scheme_of(kind, order);
    const auto corners = unit_corners(kind);
    const int p = static_cast<int>(degree);
    std::vector<LatticePlace> out;
    /// p times corner `a`, u steps towards `b`, v steps towards `c`.
    const auto add = [&](std::uint8_t a, std::uint8_t b, int u, std::uint8_t c, int v) {
        std::array<int, 3> at{};
        for (std::size_t k = 0; k < 3; ++k) {
            const int start = corners[a][k];
            at[k] = p * start + u * (corners[b][k] - start) + v * (corners[c][k] - start);
        }
        out.push_back(place_at(at[0], at[1], at[2]));
    };
    for (std::uint8_t c = 0; c < corners.size(); ++c) add(c, c, 0, c, 0);
    for (const SchemeEdge& edge : scheme.edges)
        for (int u = 1; u < p; ++u) add(edge[0], edge[1], u, edge[0], 0);
    std::vector<FlatPlace> triangle, square;
    add_triangle(p - 3, scheme.triangles, 1, triangle);
    add_square(p - 2, scheme.squares, 1, square);
    for (const SchemeFace& face : scheme.faces)
        for (const auto& [u, v] : face.count == 3 ? triangle : square)
            add(face.corners[0], face.corners[1], u, face.corners[face.count - 1U], v);
    add_inside(kind, p, order, out);
    return out;
}

std::vector<std::uint16_t> positions_in(NodeOrder order, CellKind kind, unsigned degree) {
    std::map<LatticePlace, std::uint16_t> position;
    for (const LatticePlace& place : nodes_of_degree(kind, degree, order))
        position.emplace(place, static_cast<std::uint16_t>(position.size()));
    std::vector<std::uint16_t> out;
    for (const LatticePlace& place : nodes_of_degree(kind, degree, NodeOrder::vtk)) out.push_back(position.at(place));
    return out;
}

} // namespace isotet::core
