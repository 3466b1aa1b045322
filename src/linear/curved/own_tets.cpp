// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/own_tets.hpp"

#include <cmath>

#include "linear/curved/bernstein.hpp"

namespace isotet::linear {

namespace {

constexpr int most_halvings_of_quotients = 3; // near the apex of a pyramid halves have half of the error

} // namespace

bool CellAtHand::take(std::uint64_t cell) {
    if (!look_at(cell)) return false;
    finite_ = true;
    for (std::size_t k = 0; k < own_fields; ++k) {
        cell_.values(*of_[k], values_);
        finite_ = finite_ && std::ranges::all_of(values_, [](double v) { return std::isfinite(v); });
        cell_.functions->net(values_, nets_[k]);
        double largest = 0, furthest = 0;
        for (const double v : nets_[k]) largest = std::max(largest, std::abs(v));
        for (const double v : values_) furthest = std::max(furthest, std::abs(v - values_[0]));
        // of sums in double: of the net, and of the conversion to it
        rounding_[k] = 0x1p-44 * largest + 0x1p-50 * cell_.functions->net_norm() * furthest;
    }
    return true;
}

std::array<CellPlace, 4> CellAtHand::corners(std::size_t tet) const {
    std::array<CellPlace, 4> out{};
    for (std::size_t i = 0; i < 4; ++i) out[i] = cell_.corners[tets_.locals[tet][i]];
    return out;
}

double CellAtHand::length_error_at_most() const {
    double square = 0;
    for (std::size_t k = 1; k < own_fields; ++k) {
        const double part = cell_.functions->error_at_most(nets_[k]) + rounding_[k];
        square += part * part;
    }
    return std::sqrt(square);
}

void CellAtHand::on_tet(std::size_t tet, std::size_t count, OwnTet& out) {
    const std::array<CellPlace, 4> at = corners(tet);
    Key key{cell_.functions, {}};
    for (std::size_t i = 0; i < 4; ++i) std::ranges::copy(at[i].at, key.second.begin() + static_cast<long>(3 * i));
    auto found = known_.find(key);
    if (found == known_.end()) {
        if (known_.size() > 1000) known_.clear();
        found = known_.emplace(key, cell_.functions->tet(at)).first;
    }
    out.count = count;
    out.bottom = found->second.bottom;
    for (std::size_t k = 0; k < count; ++k) cell_.functions->on_tet(nets_[k], found->second, out.top[k]);
}

OwnErrors CellAtHand::errors(const OwnTet& tet) const {
    OwnErrors out;
    const unsigned degree = cell_.functions->bernstein_degree();
    double square = 0;
    std::array<double, 6> edges2{};
    for (std::size_t k = 0; k < tet.count; ++k) {
        const QuadraticPart part = quadratic_part(degree, tet.top[k], tet.bottom);
        if (k == 0) {
            out.value = part.error + rounding_[0];
            out.bezier = part.bezier;
            out.lower = part.lower;
            out.upper = part.upper;
            continue;
        }
        square += (part.error + rounding_[k]) * (part.error + rounding_[k]);
        for (std::size_t e = 0; e < 6; ++e) {
            const double d = part.bezier[tet_edges[e][0]] - part.bezier[tet_edges[e][1]];
            edges2[e] += d * d;
        }
    }
    out.length = std::sqrt(square);
    out.value_rounding = rounding_[0];
    out.length_rounding = length_rounding();
    out.edge = std::sqrt(*std::ranges::max_element(edges2));
    return out;
}

WeightChange change_between(const Place& a, const Place& b) {
    const auto from = steps_of(a), to = steps_of(b);
    WeightChange out;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::uint32_t change = from[i] > to[i] ? from[i] - to[i] : to[i] - from[i];
        out.largest = std::max(out.largest, change);
        out.squares += static_cast<double>(change) * change;
    }
    return out;
}

void halve(unsigned degree, std::size_t edge, const OwnTet& whole, OwnTet& first, OwnTet& second) {
    const BernsteinTable& table = bernstein_table(degree);
    first.count = second.count = whole.count;
    for (std::size_t k = 0; k < whole.count; ++k) halve(table, edge, whole.top[k], first.top[k], second.top[k]);
    if (!whole.bottom.empty()) halve(table, edge, whole.bottom, first.bottom, second.bottom);
}

std::pair<int, OwnErrors> LevelFinder::find(const OwnTet& tet, const OwnErrors& errors, int most) {
    worst_ = tet;
    errors_ = errors;
    int level = 0;
    const int most_levels = std::min(most, tet.bottom.empty() ? most_halvings : most_halvings_of_quotients);
    while (level < most_levels && allowed_.excess(errors_) > 1) {
        const OwnTet whole = std::move(worst_);
        most_ = -1;
        divide(corner_places, whole);
        ++level;
    }
    return {level, errors_};
}

void LevelFinder::divide(const std::array<Place, 4>& at, const OwnTet& tet) {
    const std::size_t edge = longest_marked_edge(at, [](const Place& a, const Place& b) -> std::optional<double> {
        const WeightChange change = change_between(a, b);
        if (change.largest <= whole_weight / 2) return std::nullopt;
        return change.squares;
    });
    if (edge == 6) {
        const OwnErrors errors = hand_.errors(tet);
        if (const double excess = allowed_.excess(errors); excess > most_) {
            most_ = excess;
            errors_ = errors;
            worst_ = tet;
        }
        return;
    }
    OwnTet first, second;
    halve(hand_.cell().functions->bernstein_degree(), edge, tet, first, second);
    std::array<Place, 4> at_first = at, at_second = at;
    const auto [a, b] = tet_edges[edge];
    at_first[b] = at_second[a] = *halfway(at[a], at[b]);
    divide(at_first, first);
    divide(at_second, second);
}

} // namespace isotet::linear
