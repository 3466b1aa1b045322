// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells of any kind cut into smaller ones, and their neighbours not: grids with hanging points.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

#include <isotet/grid.hpp>

#include "grid/cells.hpp"

namespace isotet::test {

/// A grid in the making: points in double, cells of any of the four kinds.
class RefinedCells {
public:
    using Place = std::array<double, 3>;
    using Corners = std::vector<std::int64_t>;

    explicit RefinedCells(const Grid& grid) {
        for (std::size_t i = 0; i < grid.points.tuples(); ++i)
            points_.push_back({grid.points.at(i, 0), grid.points.at(i, 1), grid.points.at(i, 2)});
        const core::CellReader reader = core::CellReader::open(grid).value();
        for (std::size_t cell = 0; cell < reader.count(); ++cell) {
            const core::WholeCell whole = reader.whole(cell);
            Corners corners;
            for (std::size_t i = 0; i < core::corner_count(whole.kind); ++i)
                corners.push_back(static_cast<std::int64_t>(whole.corners[i]));
            cells_.push_back({whole.kind, corners});
        }
    }

    /// Cuts each cell with this probability.
    void refine(double probability, std::mt19937& random) {
        std::vector<Cell> before;
        before.swap(cells_);
        for (const Cell& cell : before) {
            if (std::generate_canonical<double, 32>(random) < probability) cut(cell);
            else cells_.push_back(cell);
        }
    }

    template <class Real = double>
    Grid grid() const {
        std::vector<Real> points;
        for (const Place& place : points_)
            for (const double x : place) points.push_back(static_cast<Real>(x));
        std::vector<std::int64_t> connectivity, offsets{0};
        std::vector<std::uint8_t> types;
        for (const auto& [kind, corners] : cells_) {
            connectivity.insert(connectivity.end(), corners.begin(), corners.end());
            offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
            types.push_back(std::array<std::uint8_t, 4>{10, 14, 13, 12}[static_cast<std::size_t>(kind)]);
        }
        Grid out;
        out.points = Array::own(std::move(points), 3);
        out.cells.connectivity = Array::own(std::move(connectivity));
        out.cells.offsets = Array::own(std::move(offsets));
        out.cells.types = Array::own(std::move(types));
        return out;
    }

private:
    using Kind = core::CellKind;
    struct Cell {
        Kind kind;
        Corners corners;
    };

    /// The point in the middle of others, the same for all cells that have these.
    std::int64_t middle(Corners of) {
        std::ranges::sort(of);
        const auto [at, is_new] = middles_.emplace(of, static_cast<std::int64_t>(points_.size()));
        if (!is_new) return at->second;
        Place place{};
        for (const std::int64_t point : of)
            for (std::size_t axis = 0; axis < 3; ++axis)
                place[axis] += points_[static_cast<std::size_t>(point)][axis] / static_cast<double>(of.size());
        points_.push_back(place);
        return at->second;
    }

    void cut(const Cell& cell) {
        switch (cell.kind) {
        case Kind::tetrahedron: return cut_tet(cell.corners);
        case Kind::pyramid: return cut_pyramid(cell.corners);
        case Kind::wedge: return cut_wedge(cell.corners);
        case Kind::hexahedron: return cut_hexahedron(cell.corners);
        }
    }

    /// Red refinement (Bey 1995).
    void cut_tet(const Corners& v) {
        const auto m = [&](std::size_t a, std::size_t b) { return middle({v[a], v[b]}); };
        const std::int64_t ab = m(0, 1), ac = m(0, 2), ad = m(0, 3), bc = m(1, 2), bd = m(1, 3), cd = m(2, 3);
        for (const Corners& tet : {Corners{v[0], ab, ac, ad}, Corners{ab, v[1], bc, bd}, Corners{ac, bc, v[2], cd},
                                   Corners{ad, bd, cd, v[3]}, Corners{ab, ac, ad, bd}, Corners{ab, ac, bc, bd},
                                   Corners{ac, ad, bd, cd}, Corners{ac, bc, bd, cd}})
            cells_.push_back({Kind::tetrahedron, tet});
    }

    void cut_pyramid(const Corners& v) {
        const auto m = [&](std::size_t a, std::size_t b) { return middle({v[a], v[b]}); };
        const std::int64_t base = middle({v[0], v[1], v[2], v[3]});
        std::array<std::int64_t, 4> up{};
        for (std::size_t i = 0; i < 4; ++i) up[i] = m(i, 4);
        for (std::size_t i = 0; i < 4; ++i) {
            const std::size_t next = (i + 1) % 4, before = (i + 3) % 4;
            cells_.push_back({Kind::pyramid, {v[i], m(i, next), base, m(i, before), up[i]}});
            cells_.push_back({Kind::tetrahedron, {m(i, next), base, up[i], up[next]}});
        }
        cells_.push_back({Kind::pyramid, {up[0], up[1], up[2], up[3], v[4]}});
        cells_.push_back({Kind::pyramid, {up[3], up[2], up[1], up[0], base}});
    }

    void cut_wedge(const Corners& v) {
        std::array<std::array<std::int64_t, 6>, 3> layers; // corners, then the middles of 01, 12, 20
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t next = (i + 1) % 3;
            layers[0][i] = v[i];
            layers[2][i] = v[i + 3];
            layers[1][i] = middle({v[i], v[i + 3]});
            layers[0][i + 3] = middle({v[i], v[next]});
            layers[2][i + 3] = middle({v[i + 3], v[next + 3]});
            layers[1][i + 3] = middle({v[i], v[next], v[i + 3], v[next + 3]});
        }
        constexpr std::size_t triangles[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
        for (std::size_t k = 0; k < 2; ++k)
            for (const auto& t : triangles)
                cells_.push_back({Kind::wedge,
                                  {layers[k][t[0]], layers[k][t[1]], layers[k][t[2]], layers[k + 1][t[0]],
                                   layers[k + 1][t[1]], layers[k + 1][t[2]]}});
    }

    void cut_hexahedron(const Corners& v) {
        constexpr std::size_t corner_at[8] = {0, 1, 3, 2, 4, 5, 7, 6}; // x + 2 y + 4 z
        const auto at = [&](std::size_t x, std::size_t y, std::size_t z) { // in halves
            Corners of;
            for (std::size_t i = 0; i < 8; ++i) {
                const auto is_end = [](std::size_t half, std::size_t end) { return half == 1 || half == 2 * end; };
                if (is_end(x, i & 1) && is_end(y, i >> 1 & 1) && is_end(z, i >> 2)) of.push_back(v[corner_at[i]]);
            }
            return of.size() == 1 ? of[0] : middle(of);
        };
        for (std::size_t i = 0; i < 8; ++i) {
            const std::size_t x = i & 1, y = i >> 1 & 1, z = i >> 2;
            cells_.push_back({Kind::hexahedron,
                              {at(x, y, z), at(x + 1, y, z), at(x + 1, y + 1, z), at(x, y + 1, z), at(x, y, z + 1),
                               at(x + 1, y, z + 1), at(x + 1, y + 1, z + 1), at(x, y + 1, z + 1)}});
        }
    }

    std::vector<Place> points_;
    std::vector<Cell> cells_;
    std::map<Corners, std::int64_t> middles_;
};

} // namespace isotet::test
