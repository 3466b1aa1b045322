// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids and fields written out point by point, and made ones in one line.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/make.hpp>

namespace isotet::test {

using Corners = std::array<std::int64_t, 4>;

/// Tetrahedra on points of type Real.
template <class Real = float>
Grid tet_grid(const std::vector<std::array<double, 3>>& points, const std::vector<Corners>& tets) {
    std::vector<Real> coordinates;
    for (const auto& point : points)
        for (const double x : point) coordinates.push_back(static_cast<Real>(x));
    std::vector<std::int64_t> connectivity;
    for (const Corners& tet : tets) connectivity.insert(connectivity.end(), tet.begin(), tet.end());
    Grid grid;
    grid.points = Array::own(std::move(coordinates), 3);
    grid.cells.connectivity = Array::own(std::move(connectivity));
    return grid;
}

template <class T>
PointField field_of(std::vector<T> values, std::string name = "value") {
    return {std::move(name), Array::own(std::move(values)), false, {}};
}

inline Grid made_grid(std::string shape, std::uint64_t side, std::vector<std::string> fields, std::uint64_t seed = 1) {
    MakeOptions options;
    options.shape = std::move(shape);
    options.side = side;
    options.fields = std::move(fields);
    options.seed = seed;
    return make_grid(options).value();
}

/// The point field of a grid at this place of its list.
inline PointField point_field(const Grid& grid, std::size_t place = 0) {
    return {grid.point_fields[place].name, grid.point_fields[place].values, false, {}};
}

} // namespace isotet::test
