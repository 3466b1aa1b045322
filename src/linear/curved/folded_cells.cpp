// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/folded_cells.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <vector>

#include "base/parallel.hpp"
#include "linear/curved/own_cell.hpp"

namespace isotet::linear {

namespace {

constexpr std::int64_t place_steps = 6000; ///< of a cell's place, along each axis

bool is_inside(core::CellKind kind, const CellPlace& place) {
    const auto& [u, v, w] = place.at;
    if (kind == core::CellKind::tetrahedron) return u + v + w < place_steps;
    if (kind == core::CellKind::wedge) return u + v < place_steps;
    if (kind == core::CellKind::pyramid) return u + w < place_steps && v + w < place_steps;
    return true;
}

/// From places in a cell to places.
class CellMap {
public:
    CellMap(const OwnCell& cell, const std::array<NodeValues, 3>& points) : cell_(cell) {
        for (std::size_t k = 0; k < 3; ++k) cell.values(points[k], values_[k]);
    }

    /// By differences.
    double determinant(const CellPlace& place) {
        std::array<std::array<double, 3>, 3> d{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            CellPlace lower = place, upper = place;
            --lower.at[axis];
            ++upper.at[axis];
            const auto a = at(lower), b = at(upper);
            for (std::size_t k = 0; k < 3; ++k) d[axis][k] = b[k] - a[k];
        }
        return d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) - d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
               d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
    }

private:
    std::array<double, 3> at(const CellPlace& place) {
        cell_.functions->weights(place, weights_);
        std::array<double, 3> out{};
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t n = 0; n < weights_.size(); ++n) out[k] += weights_[n] * values_[k][n];
        return out;
    }

    const OwnCell& cell_;
    std::array<std::vector<double>, 3> values_;
    std::vector<double> weights_;
};

bool is_folded(const OwnCell& cell, const std::array<NodeValues, 3>& points) {
    constexpr std::int64_t side = 6, step = place_steps / side;
    CellMap map(cell, points);
    double lowest = INFINITY, highest = -INFINITY;
    for (std::int64_t z = 0; z < side; ++z)
        for (std::int64_t y = 0; y < side; ++y)
            for (std::int64_t x = 0; x < side; ++x) {
                const CellPlace place{{step * x + step / 2, step * y + step / 2, step * z + step / 2}, place_steps};
                if (!is_inside(cell.kind, place)) continue;
                const double determinant = map.determinant(place);
                lowest = std::min(lowest, determinant);
                highest = std::max(highest, determinant);
            }
    constexpr double rounding = 1e-6; // of differences over so short a way
    const double largest = std::max(std::abs(lowest), std::abs(highest));
    return lowest < -rounding * largest && highest > rounding * largest;
}

/// The cell of a tet; without functions of its own it is what its quadratic tet is.
void find_cell(OwnCells& finder, const QuadraticTets& tets, std::uint32_t of_tet, OwnCell& cell) {
    finder.find(tets.sources[of_tet], cell);
    if (cell.functions) return;
    const QuadraticTet& tet = tets.tets[of_tet];
    cell.kind = core::CellKind::tetrahedron;
    cell.functions = &own_functions({cell.kind, 2, OwnKind::Of::lagrange});
    cell.nodes.assign(tet.begin(), tet.begin() + 4);
    for (const auto& [a, b] : quadratic_edges(cell.kind)) cell.nodes.push_back(tet[4u + tet_edge_of[a][b]]);
}

} // namespace

std::size_t folded_cells(const Grid& user, const LinearGrid& before, const QuadraticTets& tets,
                         const std::array<NodeValues, 3>& points, std::span<const std::uint32_t> of_tets) {
    std::atomic<std::size_t> folded{0};
    core::parallel_each(of_tets.size(), 16, [&](std::size_t i) {
        OwnCells finder(user, before, tets);
        OwnCell cell;
        find_cell(finder, tets, of_tets[i], cell);
        if (is_folded(cell, points)) ++folded;
    });
    return folded;
}

} // namespace isotet::linear
