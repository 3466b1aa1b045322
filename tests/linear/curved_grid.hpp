// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids of linear cells with nodes added: quadratic cells of all kinds, which share faces.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/make.hpp>

namespace isotet::test {

using At = std::array<double, 3>;

/// Local corners of the edges and quadrilaterals of VTK's linear types, in the order of quadratic nodes.
struct KindTables {
    std::vector<std::vector<int>> edges, faces;
};

inline const KindTables& tables_of(int linear_type) {
    static const std::map<int, KindTables> all{
        {10, {{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}, {}}},
        {14, {{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}, {{0, 1, 2, 3}}}},
        {13,
         {{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}},
          {{0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}}},
        {12,
         {{{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}},
          {{0, 3, 7, 4}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 2, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}}}}};
    return all.at(linear_type);
}

/// How many edges, faces and centres of its nodes a quadratic type has, and the nodes behind them that tests make up.
struct NodeCounts {
    std::uint8_t type;
    std::size_t edges, faces, centre, more = 0;
};

/// All quadratic types over a linear one.
inline std::vector<NodeCounts> quadratic_types(int linear_type) {
    switch (linear_type) {
    case 10: return {{24, 6, 0, 0}, {71, 6, 0, 0}};
    case 14: return {{27, 8, 0, 0}, {74, 8, 1, 0}, {37, 8, 1, 0, 5}};
    case 13: return {{26, 9, 0, 0}, {32, 9, 3, 0}, {73, 9, 3, 0}};
    default: return {{25, 12, 0, 0}, {29, 12, 6, 1}, {33, 12, 4, 0}, {72, 12, 6, 1}};
    }
}

struct CurvedOptions {
    std::string shape = "mixed";
    std::uint64_t side = 3;
    unsigned seed = 1;
    bool shuffle = false;                 ///< numbers of points and order of cells
    std::function<At(At)> warp = {};      ///< of the nodes
    std::function<double(At)> field = {}; ///< of the nodes before they are moved
    double keep_linear = 0;               ///< share of cells that stay linear
};

struct CurvedGrid {
    Grid grid;
    PointField field;
};

/// Takes a made grid and gives each cell a random quadratic type of its kind. Nodes of shared edges and faces are shared.
inline CurvedGrid curved_grid(const CurvedOptions& options) {
    const Grid linear = make_grid({options.shape, options.side, {"sphere"}, options.seed}).value();
    std::vector<At> at(linear.points.tuples());
    for (std::size_t i = 0; i < at.size(); ++i)
        at[i] = {linear.points.at(i, 0), linear.points.at(i, 1), linear.points.at(i, 2)};
    std::map<std::vector<std::size_t>, std::size_t> known;
    const auto middle = [&](std::vector<std::size_t> of) {
        std::ranges::sort(of);
        const auto [found, is_new] = known.try_emplace(of, at.size());
        if (!is_new) return found->second;
        At mean{};
        for (const std::size_t i : of)
            for (std::size_t k = 0; k < 3; ++k) mean[k] += at[i][k] / static_cast<double>(of.size());
        at.push_back(mean);
        return found->second;
    };
    std::mt19937 random(options.seed);
    std::vector<std::vector<std::size_t>> cells;
    std::vector<std::uint8_t> types;
    std::size_t first = 0;
    const std::map<int, std::size_t> corner_counts{{10, 4}, {14, 5}, {13, 6}, {12, 8}};
    for (std::size_t c = 0; c < linear.cells.count(); ++c) {
        const int type = linear.cells.types.empty() ? static_cast<int>(linear.cells.uniform_type)
                                                    : static_cast<int>(linear.cells.types.at(c));
        const std::size_t corners = corner_counts.at(type);
        std::vector<std::size_t> cell;
        for (std::size_t k = 0; k < corners; ++k)
            cell.push_back(static_cast<std::size_t>(linear.cells.connectivity.at(first + k)));
        first += corners;
        const auto choices = quadratic_types(type);
        const NodeCounts chosen = choices[random() % choices.size()];
        if (static_cast<double>(random() % 1000) < 1000 * options.keep_linear) {
            types.push_back(static_cast<std::uint8_t>(type));
            cells.push_back(cell);
            continue;
        }
        const KindTables& tables = tables_of(type);
        const auto of = [&](const std::vector<int>& local) {
            std::vector<std::size_t> out;
            for (const int l : local) out.push_back(cell[static_cast<std::size_t>(l)]);
            return out;
        };
        std::vector<std::size_t> nodes = cell;
        for (std::size_t e = 0; e < chosen.edges; ++e) nodes.push_back(middle(of(tables.edges[e])));
        for (std::size_t f = 0; f < chosen.faces; ++f) nodes.push_back(middle(of(tables.faces[f])));
        for (std::size_t k = 0; k < chosen.centre + chosen.more; ++k) nodes.push_back(middle(cell));
        types.push_back(chosen.type);
        cells.push_back(nodes);
    }
    std::vector<std::size_t> number(at.size()), order(cells.size());
    std::iota(number.begin(), number.end(), 0);
    std::iota(order.begin(), order.end(), 0);
    if (options.shuffle) {
        std::ranges::shuffle(number, random);
        std::ranges::shuffle(order, random);
    }
    std::vector<double> points(3 * at.size()), values(at.size());
    for (std::size_t i = 0; i < at.size(); ++i) {
        const At moved = options.warp ? options.warp(at[i]) : at[i];
        std::ranges::copy(moved, points.begin() + static_cast<std::ptrdiff_t>(3 * number[i]));
        values[number[i]] = options.field ? options.field(at[i]) : 0;
    }
    std::vector<std::int64_t> connectivity, offsets{0};
    std::vector<std::uint8_t> ordered_types;
    for (const std::size_t c : order) {
        for (const std::size_t node : cells[c]) connectivity.push_back(static_cast<std::int64_t>(number[node]));
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
        ordered_types.push_back(types[c]);
    }
    CurvedGrid out;
    out.grid.points = Array::own(std::move(points), 3);
    out.grid.cells.connectivity = Array::own(std::move(connectivity));
    out.grid.cells.offsets = Array::own(std::move(offsets));
    out.grid.cells.types = Array::own(std::move(ordered_types));
    out.field = {"f", Array::own(std::move(values)), false, {}};
    return out;
}

/// A quadratic field without symmetry.
inline double quadric(At p) {
    const auto [x, y, z] = p;
    return x * x + 0.7 * y * y - 0.4 * z * z + 0.3 * x * y - 0.6 * y * z + 0.2 * x - 0.1 * z;
}

inline double wave(At p) { return std::sin(2.5 * p[0]) + std::cos(2 * p[1]) * std::sin(2 * p[2] + 0.3); }

/// Moves points smoothly; the cube's faces bulge, too.
inline At bulge(At p) {
    const auto [x, y, z] = p;
    return {x + 0.12 * y * y - 0.05 * z * x, y + 0.1 * std::sin(1.5 * x), z - 0.08 * x * y};
}

} // namespace isotet::test
