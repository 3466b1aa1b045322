// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/bisection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace isotet::linear {

namespace {

constexpr Place free_slot{0xffffffff, 0, 0};

std::size_t hash_of(const Place& place) {
    const std::uint64_t mixed =
        (place[0] * 0x9e3779b97f4a7c15u) ^ (place[1] * 0xc2b2ae3d27d4eb4fu) ^ (place[2] * 0x165667b19e3779f9u);
    return static_cast<std::size_t>((mixed ^ mixed >> 29) * 0x9e3779b97f4a7c15u >> 20);
}
constexpr double rounding_margin = 0x1p-21; ///< of stored values beside Bezier values: float32 and more

/// The number of the corner that a place is; 4: none.
std::size_t corner_at(const Place& place) {
    return static_cast<std::size_t>(std::ranges::find(corner_places, place) - corner_places.begin());
}

double half(double a, double b) { return (a + b) / 2; }

} // namespace

Bisector::Bisector(const QuadraticTets& grid, const std::array<NodeValues, 3>& points, const NodeValues* field,
                   const BisectionRule& rule, BisectionLimits& limits, const Progress& progress)
    : grid_(grid),
      points_(points),
      field_(field),
      rule_(rule),
      limits_(limits),
      progress_(progress),
      slots_(64, free_slot),
      slot_numbers_(64) {}

/// True when a surface may pass where values lie between these two, as stored.
bool Bisector::can_be_met(double lower, double upper) const {
    if (rule_.isovalues.empty()) return true;
    const double margin = rounding_margin * std::max(std::abs(lower), std::abs(upper));
    const auto next = std::ranges::lower_bound(rule_.isovalues, lower - margin);
    return next != rule_.isovalues.end() && *next <= upper + margin;
}

bool Bisector::is_met(const Part& part) const {
    if (rule_.isovalues.empty()) return true;
    const auto [lower, upper] = std::ranges::minmax(part.values[0]);
    return can_be_met(lower, upper);
}

/// How many times an edge deviates more than it may; marked edges above 1.
double Bisector::excess_of(const Part& part, std::size_t edge, double length2) const {
    const auto [a, b] = tet_edges[edge];
    if (rule_.nodes_only) {
        const std::size_t from = corner_at(part.corners[a]), to = corner_at(part.corners[b]);
        return from < 4 && to < 4 && (*tet_)[4 + tet_edge_of[from][to]] != mean_node ? 2 : 0;
    }
    const auto off = [&](std::size_t k) {
        const auto& v = part.values[k];
        return (2 * v[4 + edge] - (v[a] + v[b])) / 4;
    };
    const double field = std::abs(off(0)), x = off(1), y = off(2), z = off(3), away2 = x * x + y * y + z * z;
    const double allowed2 = rule_.length > 0 ? rule_.length * rule_.length : rule_.bend * rule_.bend * length2;
    const double by_field = field > rule_.deviation ? field / rule_.deviation : 0;
    return std::max(by_field, away2 > allowed2 ? std::sqrt(away2 / allowed2) : 0);
}

/// Of the marked edges with the largest excess, in grades of 4 (what one bisection gains), the longest, ties by the places of
/// its ends. By length alone bisection need not end: edges along which the field is straight are never marked, and three
/// short ones can go round such an edge for ever.
Bisector::Choice Bisector::first_marked(const Part& part) {
    Choice best;
    for (std::size_t edge = 0; edge < 6; ++edge) {
        const auto [a, b] = tet_edges[edge];
        double length2 = 0;
        for (std::size_t k = 1; k < 4; ++k) {
            const double d = part.values[k][a] - part.values[k][b];
            length2 += d * d;
        }
        const double excess = excess_of(part, edge, length2);
        if (!(excess > 1)) continue;
        const int grade = std::ilogb(excess) / 2;
        if (grade < best.grade || (grade == best.grade && length2 < best.length2)) continue;
        const auto middle = halfway(part.corners[a], part.corners[b]);
        if (!middle) {
            out_->too_fine = true;
            continue;
        }
        const auto [low, high] = std::minmax(part.corners[a], part.corners[b]);
        const bool is_first =
            grade > best.grade || length2 > best.length2 || high > best.high || (high == best.high && low > best.low);
        if (is_first) best = {grade, length2, high, low, *middle, edge};
    }
    return best;
}

void Bisector::divide(const Part& part) {
    if (stopped_ || !is_met(part)) return;
    const Choice choice = first_marked(part);
    if (choice.edge == 6) return emit(part);
    const std::size_t a = tet_edges[choice.edge][0], b = tet_edges[choice.edge][1], ab = 4 + choice.edge;
    std::array<std::size_t, 2> others{};
    for (std::size_t i = 0, n = 0; i < 4; ++i)
        if (i != a && i != b) others[n++] = i;
    Part at_a = part, at_b = part; // de Casteljau
    for (std::size_t k = 0; k < 4; ++k) {
        const auto& v = part.values[k];
        auto &u = at_a.values[k], &w = at_b.values[k];
        const double am = half(v[a], v[ab]), mb = half(v[ab], v[b]), m = half(am, mb);
        u[b] = w[a] = m;
        u[ab] = am;
        w[ab] = mb;
        for (const std::size_t c : others) {
            const std::size_t ac = 4u + tet_edge_of[a][c], bc = 4u + tet_edge_of[b][c];
            u[bc] = w[ac] = half(v[ac], v[bc]);
        }
    }
    at_a.corners[b] = at_b.corners[a] = choice.middle;
    divide(at_a);
    divide(at_b);
}

/// The number of a point among those of the tet at hand and the ones before.
std::uint32_t Bisector::number_of(const Place& place) {
    if (2 * (used_slots_ + 1) > slots_.size()) {
        std::vector<Place> old(2 * slots_.size(), free_slot);
        std::vector<std::uint32_t> old_numbers(old.size());
        std::swap(slots_, old);
        std::swap(slot_numbers_, old_numbers);
        for (std::size_t i = 0; i < old.size(); ++i) {
            if (old[i] == free_slot) continue;
            std::size_t slot = hash_of(old[i]) & (slots_.size() - 1);
            while (slots_[slot] != free_slot) slot = (slot + 1) & (slots_.size() - 1);
            slots_[slot] = old[i];
            slot_numbers_[slot] = old_numbers[i];
        }
    }
    std::size_t slot = hash_of(place) & (slots_.size() - 1);
    for (; slots_[slot] != free_slot; slot = (slot + 1) & (slots_.size() - 1))
        if (slots_[slot] == place) return slot_numbers_[slot];
    slots_[slot] = place;
    slot_numbers_[slot] = static_cast<std::uint32_t>(out_->places.size());
    ++used_slots_;
    out_->places.push_back(place);
    out_->parents.push_back(index_);
    return slot_numbers_[slot];
}

/// Numbers the points of the tet at hand by their places: their order is then the same whatever was dropped.
void Bisector::order_points(std::size_t first_point, std::size_t first_tet) {
    const auto places = std::span(out_->places).subspan(first_point);
    if (std::ranges::is_sorted(places)) return;
    order_.resize(places.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) order_[i] = {places[i], i};
    std::ranges::sort(order_);
    rank_.resize(order_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
        places[i] = order_[i].first;
        rank_[order_[i].second] = static_cast<std::uint32_t>(first_point + i);
    }
    for (auto& tet : std::span(out_->tets).subspan(first_tet))
        for (std::uint32_t& point : tet) point = rank_[point - first_point];
}

void Bisector::forget_numbers() {
    if (used_slots_ == 0) return;
    if (slots_.size() > 4096) {
        slots_.resize(64);
        slot_numbers_.resize(64);
    }
    std::ranges::fill(slots_, free_slot);
    used_slots_ = 0;
}

void Bisector::emit(const Part& part) {
    const auto& v = part.values[0];
    const auto [lower, upper] = std::minmax({v[0], v[1], v[2], v[3]});
    if (!can_be_met(lower, upper)) return;
    constexpr std::uint64_t counted_at_once = 1024;
    if (++uncounted_ == counted_at_once) {
        uncounted_ = 0;
        if (limits_.tets.fetch_add(counted_at_once) > limits_.max_tets) limits_.exceeded = true;
        stopped_ = limits_.exceeded || progress_.cancelled();
    }
    std::array<std::uint32_t, 4> tet{};
    for (std::size_t i = 0; i < 4; ++i) tet[i] = number_of(part.corners[i]);
    if (grid_.odd[index_]) std::swap(tet[2], tet[3]);
    out_->tets.push_back(tet);
    for (std::size_t edge = 0; edge < 6; ++edge) {
        const auto [a, b] = tet_edges[edge];
        double away2 = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const double off = (2 * part.values[k][4 + edge] - (part.values[k][a] + part.values[k][b])) / 4;
            if (k == 0) out_->deviation = std::max(out_->deviation, std::abs(off));
            else away2 += off * off;
        }
        out_->length = std::max(out_->length, std::sqrt(away2));
    }
}

void Bisector::bisect(std::uint32_t index, Bisected& out) {
    out_ = &out;
    index_ = index;
    tet_ = &grid_.tets[index];
    const std::size_t before = out.tets.size(), first_point = out.places.size();
    Part part{};
    bool finite = true;
    if (field_) {
        part.values[0] = to_bezier(field_->of(*tet_));
        finite = std::ranges::all_of(part.values[0], [](double value) { return std::isfinite(value); });
        out.not_finite += !finite;
    }
    if (finite && is_met(part)) {
        part.corners = corner_places;
        for (std::size_t k = 0; k < 3; ++k) part.values[1 + k] = to_bezier(points_[k].of(*tet_));
        divide(part);
        forget_numbers();
        order_points(first_point, before);
    }
    out.children.push_back(static_cast<std::uint32_t>(out.tets.size() - before));
}

} // namespace isotet::linear
