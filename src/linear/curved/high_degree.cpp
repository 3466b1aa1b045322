// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/high_degree.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include <fmt/core.h>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "grid/orientation.hpp"

namespace isotet::linear {

void HighDegreeSplitter::split(std::size_t cell, const HighDegree& what, Parts& out) {
    auto found = plans_.find(what);
    if (found == plans_.end()) found = plans_.emplace(what, plan_of(what)).first;
    const DegreePlan& plan = found->second;
    const std::uint64_t first = cells_.first(cell);
    corner_of_place_.assign(plan.rows.size(), 0);
    std::vector<std::pair<std::uint64_t, double>> terms;
    for (std::size_t place = 0; place < plan.rows.size(); ++place) {
        const DegreePlan::Terms& row = plan.rows[place];
        if (row.empty()) continue;
        if (row.size() == 1) {
            corner_of_place_[place] = cells_.corner(first + row.front().first);
            continue;
        }
        terms.clear();
        for (const auto& [node, weight] : row) terms.emplace_back(cells_.corner(first + node), weight);
        std::ranges::sort(terms); // as the cell beside it has them
        points_.clear();
        weights_.clear();
        for (const auto& [point, weight] : terms) {
            points_.push_back(point);
            weights_.push_back(weight);
        }
        corner_of_place_[place] = out.add_point(points_, weights_);
    }
    for (const DegreePlan::Cell& part : plan.cells) {
        corners_.clear();
        for (const std::uint32_t place : part.places) corners_.push_back(corner_of_place_[place]);
        out.add_cell(part.type, corners_, cell);
        out.report.high_degree_parts += is_curved(part.type);
    }
    ++out.report.high_degree;
}

namespace {

struct RowKey {
    std::uint64_t hash, row;
};

template <class Index>
void renumber(Array& connectivity, std::uint64_t users, const core::Buffer<std::uint64_t>& number) {
    const auto from = connectivity.as<Index>();
    core::Buffer<Index> to(from.size());
    core::parallel_each(from.size(), 1 << 14, [&](std::size_t i) {
        const auto point = static_cast<std::uint64_t>(from[i]);
        to[i] = point < users ? from[i] : static_cast<Index>(users + number[point - users]);
    });
    connectivity = std::move(to).to_array();
}

} // namespace

void merge_rows(LinearGrid& grid) {
    const std::uint64_t count = grid.derived.count();
    if (count == 0) return;
    const auto first = grid.derived.first.as<std::uint64_t>(), points = grid.derived.points.as<std::uint64_t>();
    const auto weights = grid.derived.weights.as<double>();
    const auto terms_of = [&](auto column, std::uint64_t row) {
        return column.subspan(first[row], first[row + 1] - first[row]);
    };
    core::Buffer<RowKey> keys(count);
    core::parallel_each(count, 1 << 12, [&](std::size_t row) {
        std::uint64_t hash = 0x9e3779b97f4a7c15;
        for (std::uint64_t i = first[row]; i < first[row + 1]; ++i) {
            hash = (hash ^ points[i]) * 0xff51afd7ed558ccd;
            hash = (hash ^ (hash >> 32) ^ std::bit_cast<std::uint64_t>(weights[i])) * 0xc4ceb9fe1a85ec53;
        }
        keys[row] = {hash ^ (hash >> 29), row};
    });
    const auto compare = [&](const RowKey& a, const RowKey& b) -> int {
        if (a.hash != b.hash) return a.hash < b.hash ? -1 : 1;
        const auto pa = terms_of(points, a.row), pb = terms_of(points, b.row);
        if (!std::ranges::equal(pa, pb)) return std::ranges::lexicographical_compare(pa, pb) ? -1 : 1;
        const auto wa = terms_of(weights, a.row), wb = terms_of(weights, b.row);
        if (!std::ranges::equal(wa, wb)) return std::ranges::lexicographical_compare(wa, wb) ? -1 : 1;
        return 0;
    };
    std::ranges::sort(keys, [&](const RowKey& a, const RowKey& b) {
        const int order = compare(a, b);
        return order != 0 ? order < 0 : a.row < b.row;
    });
    core::Buffer<std::uint64_t> lowest(count), number(count);
    for (std::size_t i = 0; i < count; ++i)
        lowest[keys[i].row] = i > 0 && compare(keys[i - 1], keys[i]) == 0 ? lowest[keys[i - 1].row] : keys[i].row;
    std::vector<std::uint64_t> kept_first{0}, kept_points;
    std::vector<double> kept_weights;
    for (std::uint64_t row = 0; row < count; ++row) {
        if (lowest[row] != row) {
            number[row] = number[lowest[row]];
            continue;
        }
        number[row] = kept_first.size() - 1;
        const auto row_points = terms_of(points, row);
        const auto row_weights = terms_of(weights, row);
        kept_points.insert(kept_points.end(), row_points.begin(), row_points.end());
        kept_weights.insert(kept_weights.end(), row_weights.begin(), row_weights.end());
        kept_first.push_back(kept_points.size());
    }
    Array& connectivity = grid.grid.cells.connectivity;
    if (connectivity.type() == ScalarType::int32) renumber<std::int32_t>(connectivity, grid.user_points, number);
    else renumber<std::int64_t>(connectivity, grid.user_points, number);
    grid.derived = {Array::own(std::move(kept_first)), Array::own(std::move(kept_points)),
                    Array::own(std::move(kept_weights))};
}

bool has_high_degree(const core::CellReader& cells) {
    for (std::size_t cell = 0; cell < cells.count(); ++cell)
        if (cells.type(cell) >= first_lagrange && high_degree_of(cells.type(cell), cells.corners(cell))) return true;
    return false;
}

std::string fault_of_high_degree(const Grid& grid, const core::CellReader& cells, std::size_t cell) {
    const std::uint64_t count = cells.corners(cell), first = cells.first(cell), points = grid.points.tuples();
    const core::PointReader reader(grid.points);
    const auto name = name_of_cell_type(cells.type(cell));
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t point = cells.corner(first + i);
        if (point >= points)
            return fmt::format("cell {} ({}) has point {}, but the grid has {} points", cell, name,
                               static_cast<std::int64_t>(point), points);
        for (const double x : reader[point])
            if (!std::isfinite(x))
                return fmt::format("point {} of cell {} ({}) has a coordinate that is not finite", point, cell, name);
    }
    return {};
}

} // namespace isotet::linear
