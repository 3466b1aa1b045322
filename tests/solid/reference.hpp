// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Solids and clipped cells in the slowest, plainest way: face by face, cell by cell.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/engine.hpp>
#include <isotet/solid.hpp>

#include "solid/cell_boundary.hpp"
#include "support/random_grid.hpp"

namespace isotet::test {

/// A vertex by the ends of its edge, the one below first; a point is both. Those inside of faces are -1.
using VertexName = std::pair<std::int64_t, std::int64_t>;
using NamedPolygon = std::vector<VertexName>;

inline VertexName name_at(const Array& ends, std::uint64_t vertex) {
    return {static_cast<std::int64_t>(ends.at(vertex, 0)), static_cast<std::int64_t>(ends.at(vertex, 1))};
}

/// Without corners that follow an equal one, from the lowest on; empty where fewer than three are left.
inline NamedPolygon plain(NamedPolygon polygon) {
    polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
    while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
    if (polygon.size() < 3) return {};
    std::ranges::rotate(polygon, std::ranges::min_element(polygon));
    return polygon;
}

/// Directed edges less those that are there in both directions.
class EdgeChain {
public:
    void add(const NamedPolygon& polygon) {
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            const VertexName &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
            if (a == b) continue;
            const auto use = uses_.try_emplace({std::min(a, b), std::max(a, b)}, 0).first;
            use->second += a < b ? 1 : -1;
            if (use->second == 0) uses_.erase(use);
        }
    }
    bool is_closed() const { return uses_.empty(); }
    friend bool operator==(const EdgeChain&, const EdgeChain&) = default;

private:
    std::map<std::pair<VertexName, VertexName>, int> uses_;
};

/// One isovalue, and the side of it that is meant.
struct OneSide {
    double isovalue;
    bool above;

    SolidRange range() const { return above ? SolidRange::above(isovalue) : SolidRange::below(isovalue); }
};

/// The field's values at points, and what they say of corners and edges.
class PlainField {
public:
    PlainField(const Array& values, OneSide side) : values_(values), side_(side) {}

    double at(std::uint64_t point) const { return values_.at(point); }
    bool is_above(std::uint64_t point) const { return at(point) >= side_.isovalue; }
    bool is_in(std::uint64_t point) const { return is_above(point) == side_.above; }
    bool is_tied(std::uint64_t point) const { return at(point) == side_.isovalue; }
    /// Whether a vertex is one of the isosurface.
    bool is_on_isosurface(const VertexName& name) const {
        return name.first != name.second || (name.first >= 0 && is_tied(static_cast<std::uint64_t>(name.first)));
    }

    /// The vertex between two points, one below and one above: at a tie the one above.
    VertexName crossing(std::uint64_t a, std::uint64_t b) const {
        if (is_above(a)) std::swap(a, b);
        const std::uint64_t below = is_tied(b) ? b : a;
        return {static_cast<std::int64_t>(below), static_cast<std::int64_t>(b)};
    }

    /// The parts of a face: each run of corners at or above the isovalue is cut off.
    std::vector<NamedPolygon> parts_of(const CellPolygon& face) const {
        const std::size_t n = face.size();
        std::vector<NamedPolygon> out;
        NamedPolygon part; // of the corners below there is one, with a vertex for each end of each run
        std::size_t first = 0;
        while (side_.above && first < n && is_above(face[first])) ++first; // runs begin behind it
        for (std::size_t step = 0; step < n; ++step) {
            const std::uint64_t a = face[(first + step) % n], b = face[(first + step + 1) % n];
            if (is_in(a)) part.push_back({static_cast<std::int64_t>(a), static_cast<std::int64_t>(a)});
            if (is_above(a) != is_above(b)) part.push_back(crossing(a, b));
            if (side_.above && is_in(a) && !is_in(b)) out.push_back(plain(std::exchange(part, {})));
        }
        out.push_back(plain(std::move(part)));
        std::erase_if(out, [](const NamedPolygon& polygon) { return polygon.empty(); });
        return out;
    }

private:
    const Array& values_;
    OneSide side_;
};

/// Polygons of one cell of the grid each.
using ByCell = std::map<std::uint64_t, std::vector<NamedPolygon>>;

inline std::vector<NamedPolygon> of_cell(const ByCell& polygons, std::uint64_t cell) {
    const auto found = polygons.find(cell);
    return found == polygons.end() ? std::vector<NamedPolygon>() : found->second;
}

inline EdgeChain edges_of(const std::vector<NamedPolygon>& polygons) {
    EdgeChain out;
    for (const NamedPolygon& polygon : polygons) out.add(polygon);
    return out;
}

/// The solid of a grid whose cells are not repeated: parts of faces that one cell has, and the isosurface of the
/// reference engine, turned outwards.
struct ReferenceSolid {
    ByCell boundary;    ///< polygons
    ByCell isosurface;  ///< triangles
    ByCell all_faces;   ///< parts of the faces of each cell, outwards of it
};

inline ByCell triangles_by_cell(const Surface& surface, std::size_t first, std::size_t last) {
    ByCell out;
    const auto corners = surface.triangles.as<std::uint32_t>();
    for (std::size_t i = first; i < last; ++i) {
        NamedPolygon triangle;
        for (std::size_t k = 0; k < 3; ++k) triangle.push_back(name_at(surface.edge_ends, corners[3 * i + k]));
        if (!plain(triangle).empty())
            out[static_cast<std::uint64_t>(surface.source_cells.at(i))].push_back(plain(triangle));
    }
    return out;
}

inline ReferenceSolid reference_solid(const NastyGrid& g, OneSide side) {
    ReferenceSolid out;
    const PlainField field(g.field.values, side);
    const FacesOfCells cells(g.grid);
    std::map<CellPolygon, std::vector<std::pair<std::uint64_t, CellPolygon>>> users; // by sorted points
    for (std::uint64_t cell = 0; cell < cells.count(); ++cell) {
        const std::vector<CellPolygon> faces = cells.of(cell);
        const bool has_data = std::ranges::none_of(faces, [&](const CellPolygon& face) {
            return std::ranges::any_of(face, [&](std::uint64_t point) { return std::isnan(field.at(point)); });
        });
        if (!has_data) continue;
        for (const CellPolygon& face : faces) {
            CellPolygon sorted = face;
            std::ranges::sort(sorted);
            users[sorted].push_back({cell, face});
            for (NamedPolygon& part : field.parts_of(face)) out.all_faces[cell].push_back(std::move(part));
        }
    }
    for (const auto& [sorted, of_face] : users)
        if (of_face.size() == 1)
            for (NamedPolygon& part : field.parts_of(of_face[0].second))
                out.boundary[of_face[0].first].push_back(std::move(part));
    ContourOptions options{.method = Method::clusters, .precision = Precision::float64};
    options.engine = reference_engine();
    options.edge_ends = options.source_cells = true;
    Contour contour = Contour::create({g.grid, g.field, {}, {}}, options).value();
    const ContourResult result = contour.extract(side.isovalue).value();
    const Surface& surface = result.surfaces[0].surface;
    out.isosurface = triangles_by_cell(surface, 0, surface.triangle_count());
    if (side.above)
        for (auto& [cell, triangles] : out.isosurface)
            for (NamedPolygon& triangle : triangles) {
                std::ranges::reverse(triangle);
                triangle = plain(std::move(triangle));
            }
    return out;
}

} // namespace isotet::test
