// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The isosurface of a grid straight from the user's arrays and the words of the contract: no packing, no case table, a
// map of active edges and tied points. Only the exact sign of a tet's volume is taken from the library.
#pragma once

#include <bit>
#include <cmath>
#include <limits>
#include <set>
#include <type_traits>

#include <isotet/extract.hpp>
#include <isotet/grid.hpp>

#include "numbers/exact.hpp"
#include "support/surface_sets.hpp"

namespace isotet::test {

/// Values of a float32 field as they are stored: shifted by a power of two when some are huge or tiny, what is then
/// still tiny (and -0) as +0, infinities as +-2^91.
struct StoredField {
    std::vector<double> values; ///< by the user's points; each a float32
    double scale = 1;

    StoredField(const Array& field, const std::set<std::uint64_t>& used) {
        double smallest = INFINITY, largest = 0;
        for (const std::uint64_t point : used) {
            const double magnitude = std::abs(field.at(point));
            if (!(magnitude > 0 && magnitude < INFINITY)) continue;
            smallest = std::min(smallest, magnitude);
            largest = std::max(largest, magnitude);
        }
        if (largest > 0 && (largest >= 0x1p57 || smallest < 0x1p-70)) scale = std::exp2(56 - std::ilogb(largest));
        for (std::size_t point = 0; point < field.tuples(); ++point) {
            double value = field.at(point);
            if (std::isinf(value)) value = std::copysign(0x1p91, value);
            else if (!std::isnan(value)) value = flushed(value * scale);
            values.push_back(value);
        }
    }
    double isovalue(double user) const { return flushed(std::clamp(user * scale, -0x1p57, 0x1p57)); }

    static double flushed(double x) { return std::abs(x) < 0x1p-70 ? 0.0 : x; }
};

/// The tets of a grid upright, each once, with the cell of their first occurrence.
struct UprightTet {
    std::array<std::uint64_t, 4> corners;
    std::int64_t cell;
};

inline core::Point point_of(const Array& points, std::uint64_t number) {
    return {points.at(number, 0), points.at(number, 1), points.at(number, 2)};
}

inline std::vector<UprightTet> upright_tets(const Grid& grid) {
    const TetList list = split(grid).value();
    std::vector<int> signs;
    std::int64_t balance = 0;
    for (const auto& t : list.tets) {
        signs.push_back(core::orientation_sign(point_of(grid.points, t[0]), point_of(grid.points, t[1]),
                                               point_of(grid.points, t[2]), point_of(grid.points, t[3])));
        balance += signs.back();
    }
    std::set<std::array<std::uint64_t, 4>> seen;
    std::vector<UprightTet> tets;
    for (std::size_t i = 0; i < list.tets.size(); ++i) {
        auto t = list.tets[i], sorted = t;
        std::sort(sorted.begin(), sorted.end());
        if (!seen.insert(sorted).second) continue;
        if (signs[i] < 0 || (signs[i] == 0 && balance < 0)) std::swap(t[0], t[1]);
        tets.push_back({t, static_cast<std::int64_t>(list.cells[i])});
    }
    return tets;
}

inline std::set<std::uint64_t> used_points(const std::vector<UprightTet>& tets) {
    std::set<std::uint64_t> used;
    for (const UprightTet& tet : tets) used.insert(tet.corners.begin(), tet.corners.end());
    return used;
}

/// The polygon of one upright tet, counter-clockwise seen from above, found in a tet with right angles: its corners are
/// the active edges' (below, above). Empty when the tet is not cut.
inline std::vector<Ends> polygon_of(const std::array<std::uint64_t, 4>& tet, const std::array<bool, 4>& above) {
    static constexpr std::array<std::array<double, 3>, 4> place{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    std::vector<std::size_t> high, low;
    for (std::size_t k = 0; k < 4; ++k) (above[k] ? high : low).push_back(k);
    if (high.empty() || low.empty()) return {};
    std::vector<std::pair<std::size_t, std::size_t>> around; // (below, above)
    if (high.size() == 2) around = {{low[0], high[0]}, {low[0], high[1]}, {low[1], high[1]}, {low[1], high[0]}};
    else
        for (const std::size_t a : high)
            for (const std::size_t b : low) around.emplace_back(b, a);
    const auto middle = [&](std::size_t i, std::size_t axis) {
        return (place[around[i].first][axis] + place[around[i].second][axis]) / 2;
    };
    double rise = 0; // normal . (from the middle of the low corners to the middle of the high ones)
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
        const double normal = (middle(1, j) - middle(0, j)) * (middle(2, k) - middle(0, k)) -
                              (middle(1, k) - middle(0, k)) * (middle(2, j) - middle(0, j));
        double up = 0;
        for (const std::size_t a : high) up += place[a][axis] / static_cast<double>(high.size());
        for (const std::size_t b : low) up -= place[b][axis] / static_cast<double>(low.size());
        rise += normal * up;
    }
    if (rise < 0) std::reverse(around.begin(), around.end());
    std::vector<Ends> polygon;
    for (const auto& [below, over] : around)
        polygon.emplace_back(static_cast<std::int64_t>(tet[below]), static_cast<std::int64_t>(tet[over]));
    return polygon;
}

/// The isosurface of a float32 field. Real is the precision of the packing; points must be Real (so the origin is 0).
template <class Real>
SurfaceSets brute_weld(const Grid& grid, const Array& field, double user_isovalue, Ties ties) {
    const std::vector<UprightTet> tets = upright_tets(grid);
    const StoredField stored(field, used_points(tets));
    const double isovalue = stored.isovalue(user_isovalue);
    const auto value = [&](std::int64_t point) { return stored.values[static_cast<std::size_t>(point)]; };
    // The least Real that is not below the isovalue, and what that is too much by.
    const Real nearest = static_cast<Real>(isovalue),
               level = nearest < isovalue ? std::nextafter(nearest, std::numeric_limits<Real>::infinity()) : nearest;
    const Real rest = static_cast<Real>(isovalue - static_cast<double>(level));
    SurfaceSets sets;
    const auto add_vertex = [&](const Ends& ends) {
        const Real s0 = static_cast<Real>(value(ends.first)), s1 = static_cast<Real>(value(ends.second));
        const Real rise = s1 - s0, above_it = level - s0, part = above_it + rest;
        Real t = ends.first == ends.second ? Real(0) : part / rise;
        if (t < Real(0x1p-32)) t = 0;
        double p[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto coordinate = [&](std::int64_t point) {
                return static_cast<Real>(StoredField::flushed(grid.points.at(static_cast<std::size_t>(point), axis)));
            };
            const Real p0 = coordinate(ends.first), p1 = coordinate(ends.second);
            const Real difference = p1 - p0, step = t * difference;
            p[axis] = static_cast<double>(t == 1 ? p1 : p0 + step);
        }
        sets.vertices.emplace(ends, bits_of(p[0], p[1], p[2]));
    };
    for (const UprightTet& tet : tets) {
        std::array<bool, 4> above{};
        bool valid = true;
        for (std::size_t k = 0; k < 4; ++k) {
            const double v = stored.values[tet.corners[k]];
            valid &= !std::isnan(v);
            above[k] = v >= isovalue;
        }
        if (!valid) continue;
        std::vector<Ends> polygon = polygon_of(tet.corners, above);
        if (ties == Ties::merge) {
            for (Ends& ends : polygon)
                if (value(ends.second) == isovalue) ends.first = ends.second;
            polygon.erase(std::unique(polygon.begin(), polygon.end()), polygon.end());
            while (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
        }
        if (polygon.size() < 3) continue;
        CellTriangles& cell = sets.cells[tet.cell];
        cell.count += polygon.size() - 2;
        for (std::size_t k = 0; k < polygon.size(); ++k) {
            add_vertex(polygon[k]);
            cell.add_edge(polygon[k], polygon[(k + 1) % polygon.size()]);
        }
    }
    return sets;
}

} // namespace isotet::test
