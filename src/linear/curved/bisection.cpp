// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/bisection.hpp"

#include <algorithm>
#include <bit>
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

/// For their bend edges are bisected to points in steps of 1/64 only: a cell that folds has edges that bend at every length.
constexpr std::uint32_t bend_step = whole_weight / 64;

double half(double a, double b) { return (a + b) / 2; }

bool is_same(const Place& a, const Place& b) { return ((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2])) == 0; }

/// True when the middle of two places is none of these steps, a power of two.
bool is_finer_than(std::uint32_t step, const Place& a, const Place& b) {
    return (((a[0] + b[0]) | (a[1] + b[1]) | (a[2] + b[2])) & (2 * step - 1)) != 0;
}

/// For carried fields to points in steps of 1/4.
constexpr std::uint32_t carried_step = whole_weight / 4;

/// The power of two below a number above 1, halved and rounded down twice: how often an edge is to be bisected whose
/// deviation, squared, is so many times what it may be.
int grade_of(double excess2) { return (static_cast<int>(std::bit_cast<std::uint64_t>(excess2) >> 52U) - 1023) / 4; }

template <class T>
core::Buffer<T> copied(const std::vector<T>& from) {
    core::Buffer<T> out(from.size());
    std::ranges::copy(from, out.begin());
    return out;
}

} // namespace

Bisector::Bisector(const QuadraticTets& grid, const std::array<NodeValues, 3>& points, const NodeValues* field,
                   const BisectionRule& rule, BisectionLimits& limits, const Progress& progress)
    : grid_(grid),
      points_(points),
      field_(field),
      rule_(rule),
      limits_(limits),
      progress_(progress),
      per_deviation_(rule.deviation > 0 ? 1 / rule.deviation : 0),
      slots_(64, free_slot),
      slot_numbers_(64) {}

/// True when a surface may pass where values lie between these two, as stored.
bool Bisector::can_be_met(double lower, double upper) const {
    const double margin = rounding_margin * std::max(std::abs(lower), std::abs(upper));
    const auto next = std::ranges::lower_bound(rule_.isovalues, lower - margin);
    return next != rule_.isovalues.end() && *next <= upper + margin;
}

/// By the Bezier values.
bool Bisector::is_met(const Part& part) const {
    if (rule_.isovalues.empty()) return true;
    const auto& c = part.corners;
    auto [lower, upper] = std::minmax({c[0].value, c[1].value, c[2].value, c[3].value});
    for (std::size_t e = 0; e < 6; ++e) {
        const double value = half(c[tet_edges[e][0]].value, c[tet_edges[e][1]].value) + 2 * part.edges[e].bump;
        lower = std::min(lower, value);
        upper = std::max(upper, value);
    }
    return can_be_met(lower, upper);
}

/// The most of what carried fields deviate between two places, in what they may.
double Bisector::carried_excess(const Place& a, const Place& b) const {
    double most = 0;
    if (carried_.empty() || is_finer_than(carried_step, a, b)) return most;
    for (const auto& bezier : carried_)
        if (const double excess = deviation_between(bezier, a, b); excess > most) most = excess; // not NaN
    return most;
}

/// Marks an edge that deviates more than it may, with a grade by how much.
void Bisector::judge(Edge& edge, const Corner& a, const Corner& b) {
    edge.grade = unmarked;
    double away2 = 0, length2 = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double d = a.at[k] - b.at[k];
        length2 += d * d;
        away2 += edge.bend[k] * edge.bend[k];
    }
    edge.length2 = length2;
    if (rule_.nodes_only) return;
    const double excess =
        edge.bump * (rule_.deviations.empty() ? per_deviation_ : 1 / std::min(a.deviation, b.deviation));
    const double carried = carried_excess(a.place, b.place);
    double excess2 = std::max(excess * excess, carried * carried);
    const double allowed2 = rule_.length > 0 ? rule_.length * rule_.length : rule_.bend * rule_.bend * length2;
    if (away2 > allowed2) {
        if (rule_.length == 0 && is_finer_than(bend_step, a.place, b.place)) {
            if (told_.bent.empty() || told_.bent.back() != index_) told_.bent.push_back(index_);
        } else excess2 = std::max(excess2, away2 / allowed2);
    }
    if (excess2 > 1) edge.grade = grade_of(excess2);
}

/// Of the marked edges with the largest excess, in grades of 4 (what one bisection gains), the longest, ties by the places of
/// its ends. By length alone bisection need not end: edges along which the field is straight are never marked, and three
/// short ones can go round such an edge for ever.
std::size_t Bisector::first_marked(const Part& part) {
    std::size_t best = no_edge;
    Place low{}, high{};
    for (std::size_t edge = 0; edge < 6; ++edge) {
        const Edge& here = part.edges[edge];
        if (here.grade == unmarked) continue;
        const bool is_first = best == no_edge || here.grade > part.edges[best].grade;
        if (!is_first && (here.grade < part.edges[best].grade || here.length2 < part.edges[best].length2)) continue;
        const Place &a = part.corners[tet_edges[edge][0]].place, &b = part.corners[tet_edges[edge][1]].place;
        if (!halfway(a, b)) {
            told_.too_fine = true;
            continue;
        }
        const auto [lower, upper] = std::minmax(a, b);
        if (is_first || here.length2 > part.edges[best].length2 || upper > high || (upper == high && lower > low)) {
            best = edge;
            low = lower;
            high = upper;
        }
    }
    return best;
}

/// A quadratic field is above the mean of an edge's ends by -1/8 of its second derivative along the edge, so halves of an
/// edge have a quarter of its bump, and the edge from its middle to a third corner follows from the three sides.
void Bisector::divide(const Part& part) {
    if (stopped_ || !is_met(part)) return;
    const std::size_t first = first_marked(part);
    if (first == no_edge) return emit(part);
    const std::size_t a = tet_edges[first][0], b = tet_edges[first][1];
    const Corner &at_a = part.corners[a], &at_b = part.corners[b];
    const Edge& whole = part.edges[first];
    Corner middle;
    middle.value = half(at_a.value, at_b.value) + whole.bump;
    middle.deviation = half(at_a.deviation, at_b.deviation);
    middle.place = *halfway(at_a.place, at_b.place);
    Edge quarter;
    quarter.bump = whole.bump / 4;
    for (std::size_t k = 0; k < 3; ++k) {
        middle.at[k] = half(at_a.at[k], at_b.at[k]) + whole.bend[k];
        quarter.bend[k] = whole.bend[k] / 4;
    }
    Part lower = part, upper = part; // the halves with a and with b
    lower.corners[b] = upper.corners[a] = middle;
    lower.edges[first] = upper.edges[first] = quarter;
    judge(lower.edges[first], at_a, middle);
    judge(upper.edges[first], middle, at_b);
    for (std::size_t c = 0; c < 4; ++c) {
        if (c == a || c == b) continue;
        const std::size_t ac = tet_edge_of[a][c], bc = tet_edge_of[b][c];
        Edge inner;
        inner.bump = half(part.edges[ac].bump, part.edges[bc].bump) - quarter.bump;
        for (std::size_t k = 0; k < 3; ++k)
            inner.bend[k] = half(part.edges[ac].bend[k], part.edges[bc].bend[k]) - quarter.bend[k];
        judge(inner, middle, part.corners[c]);
        lower.edges[bc] = upper.edges[ac] = inner;
    }
    divide(lower);
    divide(upper);
}

/// The number of a point among those of the tet at hand and the ones before.
std::uint32_t Bisector::number_of(const Place& place) {
    if (2 * (used_slots_ + 1) > slots_.size()) {
        std::vector<Place> old(2 * slots_.size(), free_slot);
        std::vector<std::uint32_t> old_numbers(old.size());
        std::swap(slots_, old);
        std::swap(slot_numbers_, old_numbers);
        for (std::size_t i = 0; i < old.size(); ++i) {
            if (is_same(old[i], free_slot)) continue;
            std::size_t slot = hash_of(old[i]) & (slots_.size() - 1);
            while (!is_same(slots_[slot], free_slot)) slot = (slot + 1) & (slots_.size() - 1);
            slots_[slot] = old[i];
            slot_numbers_[slot] = old_numbers[i];
        }
    }
    std::size_t slot = hash_of(place) & (slots_.size() - 1);
    for (; !is_same(slots_[slot], free_slot); slot = (slot + 1) & (slots_.size() - 1))
        if (is_same(slots_[slot], place)) return slot_numbers_[slot];
    slots_[slot] = place;
    slot_numbers_[slot] = static_cast<std::uint32_t>(places_.size());
    ++used_slots_;
    places_.push_back(place);
    parents_.push_back(index_);
    return slot_numbers_[slot];
}

/// Numbers the points of the tet at hand by their places: their order is then the same whatever was dropped.
void Bisector::order_points(std::size_t first_point, std::size_t first_tet) {
    const auto places = std::span(places_).subspan(first_point);
    if (std::ranges::is_sorted(places)) return;
    order_.resize(places.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) order_[i] = {places[i], i};
    std::ranges::sort(order_);
    rank_.resize(order_.size());
    for (std::uint32_t i = 0; i < order_.size(); ++i) {
        places[i] = order_[i].first;
        rank_[order_[i].second] = static_cast<std::uint32_t>(first_point + i);
    }
    for (auto& tet : std::span(tets_).subspan(first_tet))
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
    const auto& c = part.corners;
    const auto [lower, upper] = std::minmax({c[0].value, c[1].value, c[2].value, c[3].value});
    if (!rule_.isovalues.empty() && !can_be_met(lower, upper)) return;
    constexpr std::uint64_t counted_at_once = 1024;
    if (++uncounted_ == counted_at_once) {
        uncounted_ = 0;
        if (limits_.tets.fetch_add(counted_at_once) > limits_.max_tets) limits_.exceeded = true;
        stopped_ = limits_.exceeded || progress_.cancelled();
    }
    std::array<std::uint32_t, 4> tet{};
    for (std::size_t i = 0; i < 4; ++i) tet[i] = number_of(c[i].place);
    if (grid_.odd[index_]) std::swap(tet[2], tet[3]);
    tets_.push_back(tet);
    for (const Edge& edge : part.edges) {
        const auto& [x, y, z] = edge.bend;
        told_.deviation = std::max(told_.deviation, std::abs(edge.bump));
        told_.length2 = std::max(told_.length2, x * x + y * y + z * z);
    }
    if (!rule_.deviations.empty()) told_.distances.add(distance_in(part));
}

/// How far a surface in a tet is at most from that of the quadratic field, if the field is as steep there as in the tet.
double Bisector::distance_in(const Part& part) const {
    double bump = 0;
    for (const Edge& edge : part.edges) bump = std::max(bump, std::abs(edge.bump));
    const auto& c = part.corners;
    std::array<double, 3> rise{};
    std::array<Point, 3> along{};
    for (std::size_t i = 0; i < 3; ++i) {
        rise[i] = c[i + 1].value - c[0].value;
        for (std::size_t k = 0; k < 3; ++k) along[i][k] = c[i + 1].at[k] - c[0].at[k];
    }
    return error_per_deviation * bump / slope(along, rise);
}

/// All points inside have just that value then (weighted_sum()), so no isosurface is there: also not the one of the value.
bool Bisector::is_constant(const Part& part) {
    return std::ranges::all_of(part.corners, [&](const Corner& c) { return c.value == part.corners[0].value; }) &&
           std::ranges::all_of(part.edges, [](const Edge& edge) { return edge.bump == 0; });
}

/// The whole of a quadratic tet.
Bisector::Part Bisector::part_of(std::uint32_t index) {
    const QuadraticTet& tet = grid_.tets[index];
    Part part;
    const auto bump = [](const std::array<double, 10>& values, std::size_t e) {
        return values[4 + e] - half(values[tet_edges[e][0]], values[tet_edges[e][1]]);
    };
    if (field_) {
        const auto values = field_->of(tet);
        for (std::size_t i = 0; i < 4; ++i) part.corners[i].value = values[i];
        for (std::size_t e = 0; e < 6; ++e) part.edges[e].bump = bump(values, e);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const auto values = points_[k].of(tet);
        for (std::size_t i = 0; i < 4; ++i) part.corners[i].at[k] = values[i];
        for (std::size_t e = 0; e < 6; ++e) part.edges[e].bend[k] = bump(values, e);
    }
    carried_.clear();
    for (const CarriedValues& carried : rule_.carried) {
        if (carried.deviation <= 0) continue;
        carried_.push_back(to_bezier(carried.values.of(tet)));
        for (double& value : carried_.back()) value /= carried.deviation;
    }
    for (std::size_t i = 0; i < 4; ++i) {
        part.corners[i].place = corner_places[i];
        if (!rule_.deviations.empty()) part.corners[i].deviation = rule_.deviations[tet[i]];
    }
    for (std::size_t e = 0; e < 6; ++e) {
        judge(part.edges[e], part.corners[tet_edges[e][0]], part.corners[tet_edges[e][1]]);
        if (rule_.nodes_only && tet[4 + e] != mean_node) part.edges[e].grade = 0;
    }
    return part;
}

std::size_t Bisector::bisect(std::uint32_t index) {
    index_ = index;
    const std::size_t before = tets_.size(), first_point = places_.size();
    const Part part = part_of(index);
    const auto is_finite = [](double value) { return std::isfinite(value); };
    const bool finite = std::ranges::all_of(part.corners, is_finite, &Corner::value) &&
                        std::ranges::all_of(part.edges, is_finite, &Edge::bump);
    told_.not_finite += !finite;
    if (finite && !(is_constant(part) && !rule_.isovalues.empty())) {
        divide(part);
        forget_numbers();
        order_points(first_point, before);
    }
    children_.push_back(static_cast<std::uint32_t>(tets_.size() - before));
    return tets_.size() - before;
}

void Bisector::keep_whole(std::uint32_t index) {
    index_ = index;
    const std::size_t before = tets_.size(), first_point = places_.size();
    Part part = part_of(index);
    const auto is_finite = [](double value) { return std::isfinite(value); };
    if (std::ranges::all_of(part.corners, is_finite, &Corner::value)) // then a middle has no value: it becomes a corner
        for (std::size_t e = 0; e < 6; ++e) {
            if (is_finite(part.edges[e].bump)) continue;
            const auto [a, b] = tet_edges[e];
            part.corners[b].place = *halfway(part.corners[a].place, part.corners[b].place);
            break;
        }
    emit(part);
    forget_numbers();
    order_points(first_point, before);
    children_.push_back(static_cast<std::uint32_t>(tets_.size() - before));
}

Bisected Bisector::take() {
    Bisected out = std::exchange(told_, {});
    out.places = copied(places_);
    out.parents = copied(parents_);
    out.tets = copied(tets_);
    out.children = copied(children_);
    places_.clear();
    parents_.clear();
    tets_.clear();
    children_.clear();
    return out;
}

} // namespace isotet::linear
