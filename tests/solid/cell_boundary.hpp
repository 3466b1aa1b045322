// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The faces of cells, in the plainest way: to be compared with a solid, vertex by vertex.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <isotet/solid.hpp>

#include "grid/cell/cell_kind.hpp"
#include "grid/cells.hpp"
#include "grid/orientation.hpp"

namespace isotet::test {

using CellPolygon = std::vector<std::uint64_t>; ///< outwards

/// The cells of a grid by their faces, outwards also of cells that are listed inside out.
class FacesOfCells {
public:
    explicit FacesOfCells(const Grid& grid) : grid_(grid), cells_(core::CellReader::open(grid).value()) {}

    std::size_t count() const { return cells_.count(); }
    std::uint8_t type(std::size_t cell) const { return cells_.type(cell); }

    std::vector<CellPolygon> of(std::size_t cell) const {
        std::vector<CellPolygon> faces = as_listed(cell);
        if (cells_.type(cell) != 42 && six_volumes(faces) < -1e-12) // else it is flat up to rounding
            for (CellPolygon& face : faces) std::ranges::reverse(face);
        return faces;
    }

    /// Of a cell, faces as fans around the mean of their vertices: the same from both sides.
    double six_volumes(const std::vector<CellPolygon>& faces) const {
        if (faces.empty()) return 0;
        const core::PointReader at(grid_.points);
        double sum = 0;
        for (const CellPolygon& face : faces) {
            core::Point mean{};
            for (const std::uint64_t vertex : face)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    mean[axis] += at[vertex][axis] / static_cast<double>(face.size());
            for (std::size_t k = 0; k < face.size(); ++k)
                sum += core::six_volumes(at[faces[0][0]], mean, at[face[k]], at[face[(k + 1) % face.size()]]);
        }
        return sum;
    }
    double six_volumes(std::size_t cell) const { return six_volumes(of(cell)); }
    /// Negative of cells that are listed inside out; wedges may be listed both ways.
    double signed_six_volumes(std::size_t cell) const {
        return cells_.type(cell) == 13 ? six_volumes(cell) : six_volumes(as_listed(cell));
    }

private:
    std::vector<CellPolygon> as_listed(std::size_t cell) const {
        std::vector<CellPolygon> out;
        if (cells_.type(cell) == 42) {
            const auto entry = [&](std::uint64_t i) { return static_cast<std::uint64_t>(grid_.cells.faces.at(i)); };
            auto at = static_cast<std::uint64_t>(grid_.cells.face_offsets.at(cell));
            for (std::uint64_t faces = entry(at++); faces > 0; --faces) {
                CellPolygon& face = out.emplace_back();
                for (std::uint64_t count = entry(at++); count > 0; --count) face.push_back(entry(at++));
            }
            return out;
        }
        const core::WholeCell whole = cells_.whole(cell);
        for (const core::CellFace& face : core::shape_of(whole.kind).faces()) {
            CellPolygon polygon;
            for (const std::uint8_t corner : face.all())
                if (polygon.empty() || polygon.back() != whole.corners[corner]) polygon.push_back(whole.corners[corner]);
            while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
            if (polygon.size() > 2) out.push_back(std::move(polygon));
        }
        return out;
    }

    const Grid& grid_;
    core::CellReader cells_;
};

/// Of all cells; those that are listed inside out count as positive, or not.
enum class InsideOut { positive, negative };
inline double total_volume(const Grid& grid, InsideOut inside_out = InsideOut::positive) {
    const FacesOfCells cells(grid);
    double sum = 0;
    for (std::size_t cell = 0; cell < cells.count(); ++cell)
        sum += (inside_out == InsideOut::positive ? cells.six_volumes(cell) : cells.signed_six_volumes(cell)) / 6;
    return sum;
}

/// From its lowest vertex on.
inline CellPolygon from_lowest(CellPolygon polygon) {
    std::ranges::rotate(polygon, std::ranges::min_element(polygon));
    return polygon;
}

inline CellPolygon reversed(CellPolygon polygon) {
    std::ranges::reverse(polygon);
    return from_lowest(std::move(polygon));
}

/// Polygons less those that are there in both directions.
class Chain {
public:
    void add(const CellPolygon& polygon) {
        const CellPolygon back = reversed(polygon);
        if (const auto found = polygons_.find(back); found != polygons_.end()) polygons_.erase(found);
        else polygons_.insert(from_lowest(polygon));
    }
    std::multiset<CellPolygon>& polygons() { return polygons_; }

private:
    std::multiset<CellPolygon> polygons_;
};

/// Numbers of vertices by what they are: place and edge ends, so that those of a grid and of a solid can be compared.
class VertexNames {
public:
    std::uint64_t of(const Array& positions, const Array& ends, std::size_t vertex) {
        const Name name{positions.at(vertex, 0), positions.at(vertex, 1), positions.at(vertex, 2), ends.at(vertex, 0),
                        ends.at(vertex, 1)};
        return numbers_.try_emplace(name, numbers_.size()).first->second;
    }

private:
    using Name = std::array<double, 5>;
    std::map<Name, std::uint64_t> numbers_;
};

/// How many triangles the cells and the solid do not have in common: 0 where the boundary of the cells is the solid.
///
/// A polygon of n vertices stands for n - 2 triangles of the solid between these.
inline std::size_t difference(const ClippedGrid& clipped, const Solid& solid) {
    VertexNames names;
    Chain cells, triangles;
    const FacesOfCells faces(clipped.grid);
    for (std::size_t cell = 0; cell < faces.count(); ++cell)
        for (CellPolygon polygon : faces.of(cell)) {
            for (std::uint64_t& vertex : polygon)
                vertex = names.of(clipped.grid.points, clipped.edge_ends, vertex);
            cells.add(polygon);
        }
    const auto corners = solid.surface.triangles.as<std::uint32_t>();
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        CellPolygon triangle;
        for (std::size_t k = 0; k < 3; ++k) {
            triangle.push_back(names.of(solid.surface.positions, solid.surface.edge_ends, corners[i + k]));
        }
        triangles.add(triangle);
    }
    std::map<std::uint64_t, std::multiset<CellPolygon>> left; // triangles by their lowest vertex
    for (const CellPolygon& triangle : triangles.polygons()) left[triangle[0]].insert(triangle);
    std::vector<CellPolygon> polygons(cells.polygons().begin(), cells.polygons().end());
    std::ranges::stable_sort(polygons, {}, &CellPolygon::size);
    std::size_t missing = 0;
    std::vector<CellPolygon> unmatched; // one triangle of each
    for (const CellPolygon& polygon : polygons) {
        const std::set<std::uint64_t> vertices(polygon.begin(), polygon.end());
        std::size_t found = 0;
        for (const std::uint64_t lowest : vertices) {
            std::multiset<CellPolygon>& some = left[lowest];
            for (auto it = some.begin(); it != some.end() && found + 2 < polygon.size();) {
                const bool is_part = std::ranges::all_of(*it, [&](std::uint64_t v) { return vertices.contains(v); }) &&
                                     (polygon.size() > 3 || *it == polygon);
                it = is_part ? some.erase(it) : std::next(it);
                found += is_part;
            }
        }
        // At ties a triangle of the isosurface may lie on a larger face: the solid lacks it and a part of that.
        const auto other = std::ranges::find_if(unmatched, [&](const CellPolygon& triangle) {
            return std::ranges::all_of(triangle, [&](std::uint64_t v) { return vertices.contains(v); });
        });
        if (found + 3 == polygon.size() && other != unmatched.end()) unmatched.erase(other);
        else if (found + 3 == polygon.size()) unmatched.push_back(polygon);
        else missing += polygon.size() - 2 - found;
    }
    for (const auto& [lowest, some] : left)
        missing += some.size();
    return missing + unmatched.size();
}

/// Every edge of a cell's faces is in two of them, once in each direction.
inline bool is_shell(const std::vector<CellPolygon>& faces) {
    std::map<std::pair<std::uint64_t, std::uint64_t>, std::array<int, 2>> uses;
    for (const CellPolygon& face : faces)
        for (std::size_t k = 0; k < face.size(); ++k) {
            const std::uint64_t a = face[k], b = face[(k + 1) % face.size()];
            ++uses[{std::min(a, b), std::max(a, b)}][a < b];
        }
    return std::ranges::all_of(uses, [](const auto& use) { return use.second == std::array{1, 1}; });
}

} // namespace isotet::test
