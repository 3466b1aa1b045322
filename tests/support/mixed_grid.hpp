// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids of all kinds of cells as nasty as they come: points and cells in any order, each cell begun at any corner, some
// missing, repeated, listed inside out, with corners pulled together; ties and NaN. All from a seed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include <isotet/grid.hpp>

#include "grid/cell/native_cells.hpp"
#include "grid/cells.hpp"
#include "support/random_grid.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {

struct MixedOptions {
    const char* shape = "mixed";
    int side = 5;
    int values = 4;       ///< integer values 0 .. values - 1; 0: smooth floats
    double no_data = 0;   ///< share of points with NaN
    double missing = 0;   ///< share of cells
    double mirrored = 0;  ///< share of cells listed inside out
    double repeated = 0;  ///< share of cells listed twice
    double moved = 0;     ///< points move by so many cell widths at most
    double collapsed = 0; ///< share of cells of which one edge becomes a point, in their neighbours, too
    bool wide = false;    ///< 64-bit indices, float64 points
};

/// The same cell, begun at another corner.
inline core::WholeCell turned(core::WholeCell cell, unsigned times) {
    using Order = std::array<std::uint8_t, 8>;
    static constexpr std::array<std::array<Order, 2>, core::cell_kind_count> turns{
        {{{{1, 2, 0, 3}, {1, 0, 3, 2}}},
         {{{1, 2, 3, 0, 4}, {1, 2, 3, 0, 4}}},
         {{{1, 2, 0, 4, 5, 3}, {3, 5, 4, 0, 2, 1}}},
         {{{1, 2, 3, 0, 5, 6, 7, 4}, {4, 0, 3, 7, 5, 1, 2, 6}}}}};
    for (unsigned i = 0; i < times; ++i) {
        const Order& order = turns[static_cast<std::size_t>(cell.kind)][i % 2];
        const auto before = cell.corners;
        for (std::size_t k = 0; k < core::corner_count(cell.kind); ++k) cell.corners[k] = before[order[k]];
    }
    return cell;
}

inline NastyGrid mixed_grid(std::uint32_t seed, const MixedOptions& o) {
    std::mt19937 random(seed);
    const auto chance = [&](double p) { return std::uniform_real_distribution<double>(0, 1)(random) < p; };
    const Grid base = made_grid(o.shape, static_cast<std::uint64_t>(o.side), {"gyroid"}, seed);
    const core::CellReader reader = core::CellReader::open(base).value();
    const std::size_t points = base.points.tuples();

    std::vector<std::uint64_t> place(points); // of each point in the new order
    std::iota(place.begin(), place.end(), std::uint64_t{0});
    std::shuffle(place.begin(), place.end(), random);
    std::vector<std::uint64_t> merged = place; // with what was pulled together
    std::vector<core::WholeCell> cells;
    for (std::size_t cell = 0; cell < reader.count(); ++cell) {
        core::WholeCell whole = reader.whole(cell);
        if (chance(o.collapsed)) {
            const core::CellFace& face =
                core::shape_of(whole.kind).faces()[random() % core::shape_of(whole.kind).face_count];
            merged[whole.corners[face.corners[0]]] = merged[whole.corners[face.corners[1]]];
        }
        if (chance(o.missing)) continue;
        whole = turned(whole, static_cast<unsigned>(random() % 6));
        if (chance(o.mirrored)) whole.corners = core::mirrored(whole.kind, whole.corners);
        cells.push_back(whole);
        if (chance(o.repeated)) cells.push_back(turned(whole, static_cast<unsigned>(random() % 6)));
    }
    std::shuffle(cells.begin(), cells.end(), random);

    static constexpr std::array<std::uint8_t, core::cell_kind_count> vtk_types{10, 14, 13, 12};
    std::vector<std::uint8_t> types;
    std::vector<std::int64_t> offsets{0}, corners;
    for (const core::WholeCell& cell : cells) {
        types.push_back(vtk_types[static_cast<std::size_t>(cell.kind)]);
        for (std::size_t k = 0; k < core::corner_count(cell.kind); ++k)
            corners.push_back(static_cast<std::int64_t>(merged[cell.corners[k]]));
        offsets.push_back(static_cast<std::int64_t>(corners.size()));
    }
    const double width = 1.0 / o.side;
    std::uniform_real_distribution<double> shift(-o.moved * width, o.moved * width);
    std::vector<double> coordinates(3 * points);
    for (std::size_t p = 0; p < points; ++p)
        for (std::size_t axis = 0; axis < 3; ++axis)
            coordinates[3 * place[p] + axis] = base.points.at(p, axis) + shift(random);
    std::vector<float> values(points);
    for (std::size_t p = 0; p < points; ++p) {
        float& value = values[place[p]];
        value = o.values ? static_cast<float>(random() % static_cast<unsigned>(o.values))
                         : static_cast<float>(base.point_fields[0].values.at(p));
        if (chance(o.no_data)) value = std::numeric_limits<float>::quiet_NaN();
    }

    NastyGrid out;
    out.grid.cells.types = Array::own(std::move(types));
    if (o.wide) {
        out.grid.points = Array::own(std::move(coordinates), 3);
        out.grid.cells.offsets = Array::own(std::move(offsets));
        out.grid.cells.connectivity = Array::own(std::move(corners));
    } else {
        out.grid.points = Array::own(std::vector<float>(coordinates.begin(), coordinates.end()), 3);
        out.grid.cells.offsets = Array::own(std::vector<std::int32_t>(offsets.begin(), offsets.end()));
        out.grid.cells.connectivity = Array::own(std::vector<std::int32_t>(corners.begin(), corners.end()));
    }
    out.field = {"value", Array::own(std::move(values)), false, {}};
    return out;
}

} // namespace isotet::test
