// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids and fields that are as nasty as they come: shuffled, with inverted, repeated and missing tets, ties, NaN, zeros
// of both signs and infinities. All from a seed, so that a failure can be run again.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/make.hpp>

namespace isotet::test {

struct NastyOptions {
    int side = 6;
    int values = 4;            ///< integer values 0 .. values - 1; 0: smooth floats
    double no_data = 0;        ///< share of points with NaN
    double missing = 0;        ///< share of tets left out
    double inverted = 0;       ///< share of tets with two corners exchanged in space (tangled), not only in order
    double mirrored = 0;       ///< share of tets whose corners are listed the other way round
    double repeated = 0;       ///< share of tets listed twice
    bool wide = false;         ///< 64-bit indices, float64 points
};

struct NastyGrid {
    Grid grid;
    PointField field;
};

inline NastyGrid nasty_grid(std::uint32_t seed, const NastyOptions& o) {
    std::mt19937 random(seed);
    const auto chance = [&](double p) { return std::uniform_real_distribution<double>(0, 1)(random) < p; };
    MakeOptions make;
    make.shape = "shuffled";
    make.side = static_cast<std::uint64_t>(o.side);
    make.fields = {"gyroid"};
    make.seed = seed;
    Grid base = make_grid(make).value();
    const std::size_t points = base.points.tuples();
    std::vector<double> coordinates(3 * points);
    for (std::size_t i = 0; i < coordinates.size(); ++i) coordinates[i] = base.points.at(i / 3, i % 3);
    std::vector<std::int64_t> corners;
    const std::size_t tets = base.cells.connectivity.size() / 4;
    for (std::size_t t = 0; t < tets; ++t) {
        if (chance(o.missing)) continue;
        std::int64_t v[4];
        for (std::size_t k = 0; k < 4; ++k) v[k] = static_cast<std::int64_t>(base.cells.connectivity.at(4 * t + k));
        if (chance(o.mirrored)) std::swap(v[0], v[1]);
        corners.insert(corners.end(), v, v + 4);
        if (chance(o.repeated)) {
            std::shuffle(v, v + 4, random);
            corners.insert(corners.end(), v, v + 4);
        }
    }
    // Tangle: move some points across their neighbours.
    if (o.inverted > 0)
        for (std::size_t p = 0; p < points; ++p)
            if (chance(o.inverted))
                for (std::size_t axis = 0; axis < 3; ++axis)
                    coordinates[3 * p + axis] += std::uniform_real_distribution<double>(-2.0, 2.0)(random) / o.side;

    std::vector<float> values(points);
    for (std::size_t p = 0; p < points; ++p) {
        if (o.values > 0)
            values[p] = static_cast<float>(std::uniform_int_distribution<int>(0, o.values - 1)(random)) - 1.0f;
        else values[p] = static_cast<float>(base.point_fields[0].values.at(p));
        if (values[p] == 0 && chance(0.5)) values[p] = -0.0f;
        if (o.values > 0 && chance(0.02)) values[p] = std::numeric_limits<float>::denorm_min();
        if (o.values > 0 && chance(0.01)) values[p] = chance(0.5) ? INFINITY : -INFINITY;
        if (chance(o.no_data)) values[p] = std::numeric_limits<float>::quiet_NaN();
    }
    NastyGrid out;
    if (o.wide) {
        out.grid.points = Array::own(std::move(coordinates), 3);
        out.grid.cells.connectivity = Array::own(std::move(corners));
    } else {
        out.grid.points = Array::own(std::vector<float>(coordinates.begin(), coordinates.end()), 3);
        out.grid.cells.connectivity = Array::own(std::vector<std::int32_t>(corners.begin(), corners.end()));
    }
    out.field = {"value", Array::own(std::move(values)), false, {}};
    return out;
}

} // namespace isotet::test
