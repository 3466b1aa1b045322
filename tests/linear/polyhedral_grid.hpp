// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids of polyhedra from lists of faces, wound and ordered at random.
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

using FaceLoop = std::vector<std::int64_t>;
using CellFaces = std::vector<FaceLoop>;

/// Begins each loop anywhere, winds it anyhow, and shuffles the faces. Seed 0 leaves them.
inline CellFaces disordered(CellFaces faces, std::mt19937& random) {
    for (FaceLoop& loop : faces) {
        std::rotate(loop.begin(), loop.begin() + static_cast<std::ptrdiff_t>(random() % loop.size()), loop.end());
        if (random() % 2) std::reverse(loop.begin(), loop.end());
    }
    std::shuffle(faces.begin(), faces.end(), random);
    return faces;
}

/// A grid in the making. Its cells' own points are listed as given, or ascending.
struct PolyhedronList {
    std::vector<std::int64_t> connectivity, offsets{0}, faces, face_offsets{0};
    std::vector<std::uint8_t> types;

    void add(const CellFaces& cell, std::vector<std::int64_t> listed = {}) {
        if (listed.empty()) {
            for (const FaceLoop& loop : cell) listed.insert(listed.end(), loop.begin(), loop.end());
            std::ranges::sort(listed);
            listed.erase(std::unique(listed.begin(), listed.end()), listed.end());
        }
        add_linear(42, listed);
        faces.push_back(static_cast<std::int64_t>(cell.size()));
        for (const FaceLoop& loop : cell) {
            faces.push_back(static_cast<std::int64_t>(loop.size()));
            faces.insert(faces.end(), loop.begin(), loop.end());
        }
        face_offsets.back() = static_cast<std::int64_t>(faces.size());
    }
    void add_linear(std::uint8_t type, const std::vector<std::int64_t>& corners) {
        types.push_back(type);
        connectivity.insert(connectivity.end(), corners.begin(), corners.end());
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
        face_offsets.push_back(static_cast<std::int64_t>(faces.size()));
    }
    Cells cells() const {
        Cells out;
        out.connectivity = Array::own(connectivity);
        out.offsets = Array::own(offsets);
        out.types = Array::own(types);
        out.faces = Array::own(faces);
        out.face_offsets = Array::own(face_offsets);
        return out;
    }
};

enum class Listed { as_corners, ascending };

/// Every cell of a linear grid as a polyhedron. Fields stay.
inline Grid as_polyhedra(const Grid& grid, Listed listed, unsigned seed) {
    std::mt19937 random(seed);
    const core::CellReader reader = core::CellReader::open(grid).value();
    PolyhedronList list;
    for (std::size_t cell = 0; cell < reader.count(); ++cell) {
        const core::WholeCell whole = reader.whole(cell);
        CellFaces faces;
        for (const core::CellFace& face : core::shape_of(whole.kind).faces()) {
            FaceLoop& loop = faces.emplace_back();
            for (const std::uint8_t corner : face.all())
                loop.push_back(static_cast<std::int64_t>(whole.corners[corner]));
        }
        std::vector<std::int64_t> corners;
        if (listed == Listed::as_corners)
            corners.assign(whole.corners.begin(),
                           whole.corners.begin() + static_cast<std::ptrdiff_t>(core::corner_count(whole.kind)));
        list.add(disordered(std::move(faces), random), corners);
    }
    Grid out = grid;
    out.cells = list.cells();
    return out;
}

struct OctreeOptions {
    unsigned seed = 1;     ///< which cells are refined, and how faces are disordered
    unsigned winding = 1;  ///< of the disorder alone
    double moved = 0.05;   ///< points move by so much of the fine spacing
    bool reversed = false; ///< cells in the opposite order
};

/// 3 x 3 x 3 cubes, about half of them cut into eight: beside these, cubes are polyhedra with hanging points, of four small
/// faces on a side, and of faces with five to eight corners. Points of a lattice that no cell uses are there, too.
inline Grid octree_grid(const OctreeOptions& o) {
    constexpr int coarse = 3, fine = 2 * coarse + 1;
    std::mt19937 random(o.seed), disorder(o.winding);
    const auto number = [&](int x, int y, int z) { return static_cast<std::int64_t>((z * fine + y) * fine + x); };
    std::vector<bool> cut(coarse * coarse * coarse);
    for (std::size_t i = 0; i < cut.size(); ++i) cut[i] = random() % 2;
    const auto is_cut = [&](int x, int y, int z) {
        const auto in = [](int i) { return i >= 0 && i < coarse; };
        return in(x) && in(y) && in(z) && cut[static_cast<std::size_t>((z * coarse + y) * coarse + x)];
    };
    std::vector<bool> used(fine * fine * fine, false);
    for (int z = 0; z < fine; ++z)
        for (int y = 0; y < fine; ++y)
            for (int x = 0; x < fine; ++x) {
                bool hanging = x % 2 == 0 && y % 2 == 0 && z % 2 == 0;
                const auto around = [](int i) { return std::array{(i + 1) / 2 - 1, i / 2}; }; // coarse cubes
                for (const int c : around(z))
                    for (const int b : around(y))
                        for (const int a : around(x)) hanging |= is_cut(a, b, c);
                used[static_cast<std::size_t>(number(x, y, z))] = hanging;
            }
    PolyhedronList list;
    std::vector<std::array<int, 3>> order;
    for (int z = 0; z < coarse; ++z)
        for (int y = 0; y < coarse; ++y)
            for (int x = 0; x < coarse; ++x) order.push_back({x, y, z});
    if (o.reversed) std::ranges::reverse(order);
    for (const auto& [x, y, z] : order) {
        if (is_cut(x, y, z)) {
            for (int k = 0; k < 8; ++k) {
                const int a = 2 * x + k % 2, b = 2 * y + k / 2 % 2, c = 2 * z + k / 4;
                list.add_linear(12, {number(a, b, c), number(a + 1, b, c), number(a + 1, b + 1, c), number(a, b + 1, c),
                                     number(a, b, c + 1), number(a + 1, b, c + 1), number(a + 1, b + 1, c + 1),
                                     number(a, b + 1, c + 1)});
            }
            continue;
        }
        CellFaces faces;
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (int side = 0; side < 2; ++side) {
                const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
                const std::array<int, 3> cube{x, y, z};
                const auto at = [&](int i, int j) {
                    std::array<int, 3> p{2 * cube[0], 2 * cube[1], 2 * cube[2]};
                    p[axis] += 2 * side;
                    p[u] += i;
                    p[v] += j;
                    return number(p[0], p[1], p[2]);
                };
                std::array<int, 3> beside = cube;
                beside[axis] += 2 * side - 1;
                if (is_cut(beside[0], beside[1], beside[2])) {
                    for (int k = 0; k < 4; ++k) {
                        const int i = k % 2, j = k / 2;
                        faces.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
                    }
                    continue;
                }
                FaceLoop& loop = faces.emplace_back();
                constexpr int around[8][2] = {{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}};
                for (const auto& [i, j] : around)
                    if (used[static_cast<std::size_t>(at(i, j))]) loop.push_back(at(i, j));
            }
        list.add(disordered(std::move(faces), disorder));
    }
    std::uniform_real_distribution<double> shift(-o.moved, o.moved);
    std::vector<double> points;
    for (int z = 0; z < fine; ++z)
        for (int y = 0; y < fine; ++y)
            for (int x = 0; x < fine; ++x)
                for (const int i : {x, y, z}) points.push_back(i + shift(random));
    Grid out;
    out.points = Array::own(std::move(points), 3);
    out.cells = list.cells();
    return out;
}

} // namespace isotet::test
