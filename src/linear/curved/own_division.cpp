// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/own_division.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <tbb/parallel_sort.h>

#include "linear/curved/bernstein.hpp"

namespace isotet::linear {

namespace {

/// Corners in the order that all tets at a face have.
QuadraticTet sorted(const QuadraticTet& tet, std::uint8_t& odd, const auto& order_of) {
    std::array<std::uint8_t, 4> at{0, 1, 2, 3};
    for (std::size_t end = 4; end > 1; --end)
        for (std::size_t i = 1; i < end; ++i)
            if (order_of(tet[at[i]]) < order_of(tet[at[i - 1]])) {
                std::swap(at[i], at[i - 1]);
                odd ^= 1;
            }
    QuadraticTet out{};
    for (std::size_t i = 0; i < 4; ++i) out[i] = tet[at[i]];
    for (std::size_t e = 0; e < 6; ++e) out[4 + e] = tet[4u + tet_edge_of[at[tet_edges[e][0]]][at[tet_edges[e][1]]]];
    return out;
}

} // namespace

bool PieceMaker::is_divided(std::size_t tet) const {
    for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < a; ++b)
            if (levels_[tets_.tets[tet][a]] > 0 && levels_[tets_.tets[tet][b]] > 0) return true;
    return false;
}

void PieceMaker::divide(std::size_t tet, const OwnTet* own, TetPieces& out) {
    tet_ = tet;
    out_ = &out;
    local_.clear();
    Part part;
    part.at = corner_places;
    if (own) part.own = *own;
    divide(part, own != nullptr);
}

std::size_t PieceMaker::first_marked(const Part& part) const {
    return longest_marked_edge(part.at, [&](const Place& a, const Place& b) -> std::optional<double> {
        const auto from = steps_of(a), to = steps_of(b);
        int level = most_halvings;
        for (std::size_t i = 0; i < 4; ++i)
            if (from[i] + to[i] > 0) level = std::min<int>(level, levels_[tets_.tets[tet_][i]]);
        const WeightChange change = change_between(a, b);
        if (change.largest <= whole_weight >> level) return std::nullopt;
        return change.squares;
    });
}

bool PieceMaker::can_be_met(double lower, double upper) const {
    if (rule_.isovalues.empty()) return true;
    constexpr double rounding = 0x1p-20; // of stored values
    const double margin = rounding * std::max(std::abs(lower), std::abs(upper));
    const auto next = std::ranges::lower_bound(rule_.isovalues, lower - margin);
    return next != rule_.isovalues.end() && *next <= upper + margin;
}

void PieceMaker::divide(const Part& part, bool has_own) {
    const bool is_judged = has_own && hand_.is_finite();
    const std::size_t edge = first_marked(part);
    if (edge == 6) return emit(part, has_own);
    const unsigned degree = has_own ? hand_.cell().functions->bernstein_degree() : 0;
    if (is_judged) {
        // Bezier values of quadratic interpolants between values from a to b are from 2a - b to 2b - a.
        const auto [lower, upper] = hull(degree, part.own.top[0], part.own.bottom);
        if (!can_be_met(2 * lower - upper, 2 * upper - lower)) return;
    }
    Part first{part.at, {}}, second{part.at, {}};
    const auto [a, b] = tet_edges[edge];
    first.at[b] = second.at[a] = *halfway(part.at[a], part.at[b]);
    if (has_own) halve(degree, edge, part.own, first.own, second.own);
    divide(first, has_own);
    divide(second, has_own);
}

void PieceMaker::emit(const Part& part, bool has_own) {
    OwnErrors errors;
    if (has_own && hand_.is_finite()) {
        errors = hand_.errors(part.own);
        const auto [lower, upper] = std::ranges::minmax(errors.bezier);
        if (!can_be_met(lower, upper)) return;
    }
    QuadraticTet tet{};
    for (std::size_t i = 0; i < 4; ++i) tet[i] = corner_node(part.at[i]);
    for (std::size_t e = 0; e < 6; ++e) tet[4 + e] = middle_node(part.at[tet_edges[e][0]], part.at[tet_edges[e][1]]);
    out_->tets.push_back(tet);
    out_->odd.push_back(tets_.odd[tet_]);
    out_->sources.push_back(tets_.sources[tet_]);
    out_->value.push_back(errors.value);
    out_->length.push_back(errors.length);
}

Node PieceMaker::corner_node(const Place& place) {
    for (std::size_t i = 0; i < 4; ++i)
        if (place == corner_places[i]) return tets_.tets[tet_][i];
    for (std::size_t e = 0; e < 6; ++e)
        if (place == *halfway(corner_places[tet_edges[e][0]], corner_places[tet_edges[e][1]]) &&
            tets_.tets[tet_][4 + e] < points_)
            return tets_.tets[tet_][4 + e];
    const auto [found, is_new] = local_.try_emplace(place, 0);
    if (!is_new) return found->second;
    PieceNode node{{mean_node, mean_node, mean_node, mean_node}, {}, static_cast<std::uint32_t>(tet_), 0};
    const auto steps = steps_of(place);
    for (std::size_t i = 0, to = 0; i < 4; ++i) {
        if (steps[i] == 0) continue;
        node.corners[to] = tets_.tets[tet_][i];
        if (to < 3) node.weights[to] = steps[i];
        ++to;
    }
    node.local = static_cast<std::uint32_t>(out_->nodes.size());
    found->second = new_node | node.local;
    out_->nodes.push_back(node);
    return found->second;
}

Node PieceMaker::middle_node(const Place& a, const Place& b) {
    for (std::size_t e = 0; e < 6; ++e) {
        const Place &c = corner_places[tet_edges[e][0]], &d = corner_places[tet_edges[e][1]];
        if ((a == c && b == d) || (a == d && b == c)) return tets_.tets[tet_][4 + e];
    }
    return corner_node(*halfway(a, b));
}

std::vector<PieceNode> PieceJoiner::number() {
    std::vector<PieceNode> all;
    std::size_t count = 0;
    for (const TetPieces& block : blocks_) {
        first_.push_back(count);
        count += block.nodes.size();
    }
    all.reserve(count);
    for (std::size_t b = 0; b < blocks_.size(); ++b)
        for (PieceNode node : blocks_[b].nodes) {
            node.local += static_cast<std::uint32_t>(first_[b]);
            all.push_back(node);
        }
    tbb::parallel_sort(all.begin(), all.end());
    numbers_.resize(count);
    std::vector<PieceNode> out;
    for (const PieceNode& node : all) {
        if (out.empty() || !out.back().is_same(node)) out.push_back(node);
        numbers_[node.local] = static_cast<Node>(points_ + out.size() - 1);
    }
    return out;
}

void PieceJoiner::join(std::uint64_t more, const Grid& grid, QuadraticTets& out, OwnBounds& bounds) {
    std::size_t count = 0;
    for (const TetPieces& block : blocks_) count += block.tets.size();
    core::Buffer<QuadraticTet> tets(count);
    core::Buffer<std::uint8_t> odd(count);
    core::Buffer<std::uint64_t> sources(count);
    bounds.value.clear();
    bounds.length.clear();
    const core::IndexColumn numbers(grid.point_numbers);
    const auto order_of = [&](Node node) {
        constexpr std::uint64_t behind = std::uint64_t{1} << 63U;
        if (node >= points_) return behind + node;
        return grid.point_numbers.empty() ? std::uint64_t{node} : numbers[node];
    };
    std::size_t to = 0;
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
        const TetPieces& block = blocks_[b];
        for (std::size_t i = 0; i < block.tets.size(); ++i, ++to) {
            QuadraticTet tet = block.tets[i];
            for (Node& node : tet) {
                if (node == mean_node) continue;
                if (node & new_node) node = numbers_[first_[b] + (node & ~new_node)];
                else if (node >= points_) node += static_cast<Node>(more - points_); // hidden
            }
            std::uint8_t flips = block.odd[i];
            tets[to] = sorted(tet, flips, order_of);
            odd[to] = flips;
            sources[to] = block.sources[i];
        }
        bounds.value.insert(bounds.value.end(), block.value.begin(), block.value.end());
        bounds.length.insert(bounds.length.end(), block.length.begin(), block.length.end());
    }
    out.tets = std::move(tets);
    out.odd = std::move(odd);
    out.sources = std::move(sources);
    out.locals = {};
    for (Node& node : out.cell_nodes)
        if (node != mean_node && node >= points_) node += static_cast<Node>(more - points_);
}

} // namespace isotet::linear
