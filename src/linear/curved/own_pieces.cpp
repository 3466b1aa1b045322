// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/own_pieces.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <compare>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "linear/curved/bernstein.hpp"
#include "linear/curved/own_cell.hpp"
#include "linear/place.hpp"

namespace isotet::linear {

namespace {

constexpr int max_level = 6, max_level_of_quotients = 3; ///< near the apex of a pyramid halves have half of the error
constexpr std::size_t coordinates = 3, fields = 4;       ///< the field, then x, y, z

/// The tets of one cell stand together.
struct CellTets {
    std::uint64_t cell;
    std::size_t first, end;
};

std::vector<CellTets> tets_by_cell(const QuadraticTets& tets) {
    std::vector<CellTets> out;
    for (std::size_t i = 0; i < tets.sources.size(); ++i) {
        if (out.empty() || out.back().cell != tets.sources[i]) out.push_back({tets.sources[i], i, i});
        out.back().end = i + 1;
    }
    return out;
}

/// Four polynomials on a tet: the field, x, y and z; of these only the field where the cell is what its tets are.
struct OwnTet {
    std::array<std::vector<double>, fields> top;
    std::vector<double> bottom;
    std::size_t count = 1;
};

struct OwnErrors {
    double value = 0, length = 0, edge = 0;         ///< of the field; of places; the longest edge
    double value_rounding = 0, length_rounding = 0; ///< what of these may be rounding
    std::array<double, 10> bezier{};                ///< of the field
    double lower = 0, upper = 0;                    ///< of its values
};

/// The functions of one cell after another.
class CellAtHand {
public:
    CellAtHand(const Grid& user, const LinearGrid& before, const QuadraticTets& tets, const NodeValues& field,
               const std::array<NodeValues, 3>& points)
        : cells_(user, before, tets), tets_(tets), of_{&field, &points[0], &points[1], &points[2]} {}

    /// For weights only: without values. False where the quadratic tets are the cell.
    bool look_at(std::uint64_t cell) {
        cells_.find(cell, cell_);
        return cell_.functions != nullptr;
    }

    /// The same, with the values.
    bool take(std::uint64_t cell) {
        if (!look_at(cell)) return false;
        finite_ = true;
        for (std::size_t k = 0; k < fields; ++k) {
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

    bool is_finite() const { return finite_; }
    const OwnCell& cell() const { return cell_; }
    std::array<CellPlace, 4> corners(std::size_t tet) const {
        std::array<CellPlace, 4> out{};
        for (std::size_t i = 0; i < 4; ++i) out[i] = cell_.corners[tets_.locals[tet][i]];
        return out;
    }

    /// In all the cell, without a look at its tets.
    double value_error_at_most() const { return cell_.functions->error_at_most(nets_[0]) + rounding_[0]; }
    double value_rounding() const { return rounding_[0]; }
    double length_rounding() const { return std::max({rounding_[1], rounding_[2], rounding_[3]}); }
    double length_error_at_most() const {
        double square = 0;
        for (std::size_t k = 1; k < fields; ++k) {
            const double part = cell_.functions->error_at_most(nets_[k]) + rounding_[k];
            square += part * part;
        }
        return std::sqrt(square);
    }

    void on_tet(std::size_t tet, std::size_t count, OwnTet& out) {
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

    OwnErrors errors(const OwnTet& tet) const {
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

private:
    using Key = std::pair<const OwnFunctions*, std::array<std::int64_t, 12>>;

    OwnCells cells_;
    const QuadraticTets& tets_;
    std::array<const NodeValues*, fields> of_;
    OwnCell cell_;
    bool finite_ = true;
    std::vector<double> values_;
    std::array<std::vector<double>, fields> nets_;
    std::array<double, fields> rounding_{};
    std::map<Key, OwnFunctions::Tet> known_;
};

/// Of the marked edges the longest, ties by the places of the ends; 6: none. `is_marked` gives the square of the length, or
/// nothing.
std::size_t first_of(const std::array<Place, 4>& at, const auto& is_marked) {
    const auto ends = [&](std::size_t e) {
        const auto [lower, upper] = std::minmax(at[tet_edges[e][0]], at[tet_edges[e][1]]);
        return std::pair(upper, lower);
    };
    std::size_t best = 6;
    double best2 = 0;
    for (std::size_t e = 0; e < 6; ++e) {
        const std::optional<double> length2 = is_marked(at[tet_edges[e][0]], at[tet_edges[e][1]]);
        if (!length2 || (best < 6 && (*length2 < best2 || (*length2 == best2 && ends(e) < ends(best))))) continue;
        best = e;
        best2 = *length2;
    }
    return best;
}

struct Change {
    std::uint32_t largest = 0; ///< of a weight
    double squares = 0;
};

Change change_between(const Place& a, const Place& b) {
    const auto from = steps_of(a), to = steps_of(b);
    Change out;
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

/// What the error of a tet may be.
struct Allowed {
    double value = 0, length = 0, share = 0; ///< length 0: the share of the longest edge

    double excess(const OwnErrors& errors) const {
        const double most = length > 0 ? length : share * errors.edge;
        const auto over = [](double error, double rounding, double allowed) {
            return error > 16 * rounding ? error / allowed : 0;
        };
        return std::max(over(errors.value, errors.value_rounding, value),
                        over(errors.length, errors.length_rounding, most));
    }
};

/// How often a tet must be halved along each edge: on the way to the worst part of the worst part. With the errors there.
class LevelFinder {
public:
    LevelFinder(const CellAtHand& hand, const Allowed& allowed) : hand_(hand), allowed_(allowed) {}

    std::pair<int, OwnErrors> find(const OwnTet& tet, const OwnErrors& errors, int most = max_level) {
        worst_ = tet;
        errors_ = errors;
        int level = 0;
        const int most_levels = std::min(most, tet.bottom.empty() ? max_level : max_level_of_quotients);
        while (level < most_levels && allowed_.excess(errors_) > 1) {
            const OwnTet whole = std::move(worst_);
            most_ = -1;
            divide(corner_places, whole);
            ++level;
        }
        return {level, errors_};
    }

private:
    void divide(const std::array<Place, 4>& at, const OwnTet& tet) {
        const std::size_t edge = first_of(at, [](const Place& a, const Place& b) -> std::optional<double> {
            const Change change = change_between(a, b);
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

    const CellAtHand& hand_;
    Allowed allowed_;
    OwnTet worst_;
    OwnErrors errors_;
    double most_ = -1;
};

/// What all tets at a new point know of it; `tet` and `local` are where one of them has it.
struct PieceNode {
    std::array<Node, 4> corners; ///< those that weigh something; then mean_node
    std::array<std::uint32_t, 3> weights;
    std::uint32_t tet, local;

    bool is_same(const PieceNode& other) const { return corners == other.corners && weights == other.weights; }
    auto operator<=>(const PieceNode&) const = default;
};

constexpr std::uint32_t new_node = 1u << 31; ///< of the nodes of a block

struct Pieces {
    std::vector<QuadraticTet> tets; ///< nodes as before, or new_node and a number in `nodes`
    std::vector<std::uint8_t> odd;
    std::vector<std::uint64_t> sources;
    std::vector<double> value, length;
    std::vector<PieceNode> nodes;
};

class PieceMaker {
public:
    PieceMaker(const QuadraticTets& tets, std::uint64_t points, const std::vector<std::uint8_t>& levels,
               const OwnRule& rule, CellAtHand& at_hand)
        : tets_(tets), points_(points), levels_(levels), rule_(rule), hand_(at_hand) {}

    /// True when some edge of a tet is marked.
    bool is_divided(std::size_t tet) const {
        for (std::size_t a = 0; a < 4; ++a)
            for (std::size_t b = 0; b < a; ++b)
                if (levels_[tets_.tets[tet][a]] > 0 && levels_[tets_.tets[tet][b]] > 0) return true;
        return false;
    }

    /// `own`   null: the quadratic functions of the tet are the cell's
    void divide(std::size_t tet, const OwnTet* own, Pieces& out) {
        tet_ = tet;
        out_ = &out;
        local_.clear();
        Part part;
        part.at = corner_places;
        if (own) part.own = *own;
        divide(part, own != nullptr);
    }

private:
    struct Part {
        std::array<Place, 4> at;
        OwnTet own;
    };

    std::size_t first_marked(const Part& part) const {
        return first_of(part.at, [&](const Place& a, const Place& b) -> std::optional<double> {
            const auto from = steps_of(a), to = steps_of(b);
            int level = max_level;
            for (std::size_t i = 0; i < 4; ++i)
                if (from[i] + to[i] > 0) level = std::min<int>(level, levels_[tets_.tets[tet_][i]]);
            const Change change = change_between(a, b);
            if (change.largest <= whole_weight >> level) return std::nullopt;
            return change.squares;
        });
    }

    bool can_be_met(double lower, double upper) const {
        if (rule_.isovalues.empty()) return true;
        constexpr double rounding = 0x1p-20; // of stored values
        const double margin = rounding * std::max(std::abs(lower), std::abs(upper));
        const auto next = std::ranges::lower_bound(rule_.isovalues, lower - margin);
        return next != rule_.isovalues.end() && *next <= upper + margin;
    }

    void divide(const Part& part, bool has_own) {
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

    void emit(const Part& part, bool has_own) {
        OwnErrors errors;
        if (has_own && hand_.is_finite()) {
            errors = hand_.errors(part.own);
            const auto [lower, upper] = std::ranges::minmax(errors.bezier);
            if (!can_be_met(lower, upper)) return;
        }
        QuadraticTet tet{};
        for (std::size_t i = 0; i < 4; ++i) tet[i] = corner_node(part.at[i]);
        for (std::size_t e = 0; e < 6; ++e)
            tet[4 + e] = middle_node(part.at[tet_edges[e][0]], part.at[tet_edges[e][1]]);
        out_->tets.push_back(tet);
        out_->odd.push_back(tets_.odd[tet_]);
        out_->sources.push_back(tets_.sources[tet_]);
        out_->value.push_back(errors.value);
        out_->length.push_back(errors.length);
    }

    Node corner_node(const Place& place) {
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

    /// Whole edges of the tet keep their middles, also those that are no points.
    Node middle_node(const Place& a, const Place& b) {
        for (std::size_t e = 0; e < 6; ++e) {
            const Place &c = corner_places[tet_edges[e][0]], &d = corner_places[tet_edges[e][1]];
            if ((a == c && b == d) || (a == d && b == c)) return tets_.tets[tet_][4 + e];
        }
        return corner_node(*halfway(a, b));
    }

    const QuadraticTets& tets_;
    std::uint64_t points_;
    const std::vector<std::uint8_t>& levels_;
    const OwnRule& rule_;
    CellAtHand& hand_;
    std::size_t tet_ = 0;
    Pieces* out_ = nullptr;
    std::map<Place, Node> local_;
};

/// The points that new nodes are sums of.
class RowMaker {
public:
    RowMaker(const LinearGrid& before, const QuadraticTets& tets, std::uint64_t points)
        : before_(before), tets_(tets), points_(points) {}

    /// Of the own functions of the cell, or of the tet.
    void make(const PieceNode& node, std::array<std::uint32_t, 4> steps, CellAtHand& hand, bool has_own) {
        terms_.clear();
        if (has_own) {
            const OwnCell& cell = hand.cell();
            cell.functions->weights(place_in_cell(steps, hand.corners(node.tet)), weights_);
            for (std::size_t i = 0; i < weights_.size(); ++i) {
                if (weights_[i] == 0) continue;
                if (cell.nodes[i] != mean_node) add(cell.nodes[i], weights_[i]);
                else
                    for (const Node end : cell.ends(i)) add(end, weights_[i] / 2);
            }
        } else {
            const QuadraticTet& tet = tets_.tets[node.tet];
            const auto weights = node_weights({steps[0], steps[1], steps[2]});
            for (std::size_t i = 0; i < 10; ++i) {
                if (weights[i] == 0) continue;
                if (tet[i] != mean_node) add(tet[i], weights[i]);
                else
                    for (const std::uint8_t end : tet_edges[i - 4]) add(tet[end], weights[i] / 2);
            }
        }
        std::ranges::sort(terms_);
        std::size_t to = 0;
        for (std::size_t i = 0; i < terms_.size(); ++i) {
            if (to > 0 && terms_[to - 1].first == terms_[i].first) terms_[to - 1].second += terms_[i].second;
            else terms_[to++] = terms_[i];
        }
        terms_.resize(to);
        std::erase_if(terms_, [](const auto& term) { return term.second == 0; });
    }

    const std::vector<std::pair<std::uint64_t, double>>& terms() const { return terms_; }

private:
    void add(std::uint64_t node, double weight) {
        if (node < before_.user_points) return terms_.emplace_back(node, weight), void();
        const DerivedPoints& rows = node < points_ ? before_.derived : tets_.hidden;
        const std::uint64_t row = node < points_ ? node - before_.user_points : node - points_;
        const auto first = rows.first.as<std::uint64_t>(), of = rows.points.as<std::uint64_t>();
        const std::uint64_t count = first[row + 1] - first[row];
        for (std::uint64_t i = first[row]; i < first[row + 1]; ++i)
            add(of[i], weight * (rows.weights.empty() ? 1 / static_cast<double>(count) : rows.weights.as<double>()[i]));
    }

    const LinearGrid& before_;
    const QuadraticTets& tets_;
    std::uint64_t points_;
    std::vector<double> weights_;
    std::vector<std::pair<std::uint64_t, double>> terms_;
};

/// Rows of weights, as many as there are, behind others.
DerivedPoints with_rows(const DerivedPoints& before,
                        const std::vector<std::vector<std::pair<std::uint64_t, double>>>& rows) {
    std::vector<std::uint64_t> first{0}, points;
    std::vector<double> weights;
    if (before.count() > 0) {
        const auto known = before.first.as<std::uint64_t>(), of = before.points.as<std::uint64_t>();
        first.assign(known.begin(), known.end());
        points.assign(of.begin(), of.end());
        if (!before.weights.empty()) {
            const auto have = before.weights.as<double>();
            weights.assign(have.begin(), have.end());
        } else {
            for (std::size_t row = 0; row + 1 < first.size(); ++row)
                weights.insert(weights.end(), first[row + 1] - first[row],
                               1 / static_cast<double>(first[row + 1] - first[row]));
        }
    }
    for (const auto& row : rows) {
        for (const auto& [point, weight] : row) {
            points.push_back(point);
            weights.push_back(weight);
        }
        first.push_back(points.size());
    }
    return {Array::own(std::move(first)), Array::own(std::move(points)), Array::own(std::move(weights))};
}

/// The pieces of all blocks with new points numbered.
class PieceJoiner {
public:
    PieceJoiner(std::vector<Pieces>& blocks, const QuadraticTets& tets, std::uint64_t points)
        : blocks_(blocks), tets_(tets), points_(points) {}

    /// Returns one of each new point, in the order of their numbers.
    std::vector<PieceNode> number() {
        std::vector<PieceNode> all;
        std::size_t count = 0;
        for (const Pieces& block : blocks_) {
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

    /// `more`   how many points there are now
    void join(std::uint64_t more, const Grid& grid, QuadraticTets& out, OwnBounds& bounds) {
        std::size_t count = 0;
        for (const Pieces& block : blocks_) count += block.tets.size();
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
            const Pieces& block = blocks_[b];
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

private:
    /// Corners in the order that all tets at a face have.
    static QuadraticTet sorted(const QuadraticTet& tet, std::uint8_t& odd, const auto& order_of) {
        std::array<std::uint8_t, 4> at{0, 1, 2, 3};
        for (std::size_t end = 4; end > 1; --end)
            for (std::size_t i = 1; i < end; ++i)
                if (order_of(tet[at[i]]) < order_of(tet[at[i - 1]])) {
                    std::swap(at[i], at[i - 1]);
                    odd ^= 1;
                }
        QuadraticTet out{};
        for (std::size_t i = 0; i < 4; ++i) out[i] = tet[at[i]];
        for (std::size_t e = 0; e < 6; ++e)
            out[4 + e] = tet[4u + tet_edge_of[at[tet_edges[e][0]]][at[tet_edges[e][1]]]];
        return out;
    }

    std::vector<Pieces>& blocks_;
    const QuadraticTets& tets_;
    std::uint64_t points_;
    std::vector<std::size_t> first_;
    std::vector<Node> numbers_;
};

void raise(std::uint8_t& level, int to) {
    std::atomic_ref shared(level);
    std::uint8_t seen = shared.load(std::memory_order_relaxed);
    while (seen < to && !shared.compare_exchange_weak(seen, static_cast<std::uint8_t>(to), std::memory_order_relaxed)) {
    }
}

/// Raises levels for carried fields.
void follow_carried(const Grid& user, const LinearGrid& before, const QuadraticTets& tets,
                    const std::vector<CellTets>& cells, const std::array<NodeValues, 3>& points,
                    const CarriedValues& carried, std::vector<std::uint8_t>& levels, const Progress& progress) {
    constexpr int most = 2;           // halves of halves
    constexpr double share = 3.0 / 8; // of the error that is allowed
    const double allowed = share * error_per_deviation * carried.deviation;
    core::parallel_pieces(cells.size(), 64, progress, [&](std::size_t begin, std::size_t end) {
        CellAtHand hand(user, before, tets, carried.values, points);
        OwnTet own;
        for (std::size_t c = begin; c < end; ++c) {
            if (!hand.take(cells[c].cell) || !hand.is_finite() || hand.value_error_at_most() <= allowed) continue;
            LevelFinder finder(hand, {allowed, 0, 1});
            int level = 0;
            for (std::size_t tet = cells[c].first; tet < cells[c].end; ++tet) {
                hand.on_tet(tet, 1, own);
                level = std::max(level, finder.find(own, hand.errors(own), most).first);
            }
            for (std::size_t tet = cells[c].first; level > 0 && tet < cells[c].end; ++tet)
                for (std::size_t i = 0; i < 4; ++i) raise(levels[tets.tets[tet][i]], level);
        }
    });
}

/// Polyhedra are quadratic on faces and edges that cells of degree 3 and above have, too: nothing is divided there.
void keep_beside_polyhedra(const Grid& user, const LinearGrid& before, const QuadraticTets& tets,
                           std::vector<std::uint8_t>& levels) {
    if (before.report.polyhedra == 0 || before.report.high_degree == 0) return;
    const auto users = core::CellReader::open({user.points, user.cells, {}, {}}).value();
    const auto sources = before.source_cells.as<std::uint64_t>();
    constexpr std::uint8_t high = 1, linear = 2;
    std::vector<std::uint8_t> has(levels.size(), 0);
    for (std::size_t tet = 0; tet < tets.tets.size(); ++tet) {
        const std::uint64_t cell = sources[tets.sources[tet]];
        const auto what = high_degree_of(users.type(cell), users.corners(cell));
        if (is_curved(users.type(cell)) && !(what && what->degree > 2)) continue;
        for (std::size_t i = 0; i < 4; ++i) has[tets.tets[tet][i]] |= what ? high : linear;
    }
    for (std::size_t point = 0; point < levels.size(); ++point)
        if (has[point] == (high | linear)) levels[point] = 0;
}

Error following_cancelled() { return {ErrorCode::cancelled, "refining was cancelled"}; }

} // namespace

Result<OwnBounds> follow_own_functions(const Grid& user, LinearGrid& before, QuadraticTets& tets,
                                       const NodeValues& field, const std::array<NodeValues, 3>& points,
                                       const OwnRule& rule, const Progress& progress) {
    const std::uint64_t count = before.grid.points.tuples();
    const std::vector<CellTets> cells = tets_by_cell(tets);
    std::vector<double> value(tets.tets.size(), 0), length(tets.tets.size(), 0), expected(cells.size(), 0);
    std::vector<std::uint8_t> levels(count, 0), curved(cells.size(), 0);
    std::atomic<bool> differs{false}, deep{false};
    constexpr double negligible = 1.0 / 64;
    core::parallel_pieces(cells.size(), 64, progress, [&](std::size_t begin, std::size_t end) {
        CellAtHand hand(user, before, tets, field, points);
        OwnTet own;
        for (std::size_t c = begin; c < end; ++c) {
            if (!hand.take(cells[c].cell) || !hand.is_finite()) continue;
            const auto [cell, first, last] = cells[c];
            const double of_value = hand.value_error_at_most(), of_length = hand.length_error_at_most();
            if (of_value > 0 || of_length > 0) differs.store(true, std::memory_order_relaxed);
            double edge = 0;
            for (std::size_t k = 0; k < coordinates; ++k) {
                const double side = std::abs(points[k][tets.tets[first][0]] - points[k][tets.tets[first][1]]);
                edge = std::max(edge, side);
            }
            const double allowed_length = rule.length > 0 ? rule.length : rule.share * edge;
            double most = of_value;
            int level = 0;
            curved[c] = of_length > std::max(negligible * allowed_length, 16 * hand.length_rounding());
            if (of_value > std::max(negligible * rule.value, 16 * hand.value_rounding()) || curved[c]) {
                most = 0;
                LevelFinder finder(hand, {rule.value, rule.length, rule.share});
                for (std::size_t tet = first; tet < last; ++tet) {
                    hand.on_tet(tet, curved[c] ? fields : 1, own);
                    const OwnErrors errors = hand.errors(own);
                    value[tet] = std::min(of_value, errors.value);
                    length[tet] = std::min(of_length, errors.length);
                    if (!curved[c]) length[tet] = of_length;
                    const auto [needed, left] = finder.find(own, errors);
                    level = std::max(level, needed);
                    most = std::max(most, std::min(of_value, left.value));
                }
            } else {
                for (std::size_t tet = first; tet < last; ++tet) {
                    value[tet] = of_value;
                    length[tet] = of_length;
                }
            }
            expected[c] = most;
            if (level == 0) continue;
            deep.store(true, std::memory_order_relaxed);
            for (std::size_t tet = first; tet < last; ++tet)
                for (std::size_t i = 0; i < 4; ++i) raise(levels[tets.tets[tet][i]], level);
        }
    });
    for (const CarriedValues& carried : rule.carried)
        follow_carried(user, before, tets, cells, points, carried, levels, progress);
    keep_beside_polyhedra(user, before, tets, levels);
    if (progress.cancelled()) return following_cancelled();
    if (!rule.carried.empty() && std::ranges::any_of(levels, [](std::uint8_t level) { return level > 0; }))
        differs = deep = true;
    OwnBounds bounds;
    if (!differs) return bounds;
    bounds.expected = expected.empty() ? 0 : *std::ranges::max_element(expected);
    bounds.value = std::move(value);
    bounds.length = std::move(length);
    if (!deep) return bounds;

    constexpr std::size_t cells_per_block = 16;
    std::vector<Pieces> blocks((cells.size() + cells_per_block - 1) / cells_per_block);
    const std::uint64_t free = core::free_memory();
    std::atomic<std::uint64_t> made{0};
    constexpr std::uint64_t bytes_per_piece = 1024; // with its share of rows
    core::parallel_pieces(blocks.size(), 4, progress, [&](std::size_t begin, std::size_t end) {
        CellAtHand hand(user, before, tets, field, points);
        PieceMaker maker(tets, count, levels, rule, hand);
        OwnTet own;
        for (std::size_t b = begin; b < end && made.load() * bytes_per_piece < free; ++b) {
            Pieces& out = blocks[b];
            for (std::size_t c = b * cells_per_block; c < std::min(cells.size(), (b + 1) * cells_per_block); ++c) {
                const auto [cell, first, last] = cells[c];
                const bool has_own = hand.take(cell);
                for (std::size_t tet = first; tet < last; ++tet) {
                    if (maker.is_divided(tet)) {
                        if (has_own) hand.on_tet(tet, curved[c] ? fields : 1, own);
                        const std::size_t from = out.tets.size();
                        maker.divide(tet, has_own ? &own : nullptr, out);
                        if (!curved[c])
                            for (std::size_t i = from; i < out.tets.size(); ++i) out.length[i] = bounds.length[tet];
                        continue;
                    }
                    out.tets.push_back(tets.tets[tet]);
                    out.odd.push_back(tets.odd[tet]);
                    out.sources.push_back(cell);
                    out.value.push_back(bounds.value[tet]);
                    out.length.push_back(bounds.length[tet]);
                }
            }
            made += out.tets.size();
        }
    });
    if (progress.cancelled()) return following_cancelled();
    if (made.load() * bytes_per_piece >= free)
        return Error{ErrorCode::out_of_memory,
                     fmt::format("following the cells' own functions takes over {} quadratic tets, the most that {} of "
                                 "memory allow: a larger tolerance takes fewer",
                                 made.load(), format_bytes(free))};
    if (made == 0) { // no isovalue is met: what contours takes no grid without cells
        bounds.value.assign(tets.tets.size(), 0);
        bounds.length.assign(tets.tets.size(), 0);
        return bounds;
    }
    PieceJoiner joiner(blocks, tets, count);
    const std::vector<PieceNode> nodes = joiner.number();
    const std::uint64_t more = count + nodes.size();
    if (more + tets.hidden.count() >= max_nodes)
        return Error{ErrorCode::out_of_memory,
                     fmt::format("following the cells' own functions takes {} points, but there may be at most {}: a "
                                 "larger tolerance takes fewer",
                                 more, max_nodes)};
    std::vector<std::vector<std::pair<std::uint64_t, double>>> rows(nodes.size());
    core::parallel_pieces(nodes.size(), 256, progress, [&](std::size_t begin, std::size_t end) {
        CellAtHand hand(user, before, tets, field, points);
        RowMaker maker(before, tets, count);
        std::optional<std::uint64_t> at_hand;
        bool has_own = false;
        for (std::size_t i = begin; i < end; ++i) {
            const PieceNode& node = nodes[i];
            if (const std::uint64_t cell = tets.sources[node.tet]; at_hand != cell) {
                has_own = hand.look_at(cell);
                at_hand = cell;
            }
            std::array<std::uint32_t, 4> steps{};
            std::uint32_t rest = whole_weight;
            for (std::size_t k = 0; k < 4 && node.corners[k] != mean_node; ++k) {
                const auto corner = static_cast<std::size_t>(std::ranges::find(tets.tets[node.tet], node.corners[k]) -
                                                             tets.tets[node.tet].begin());
                const bool is_last = k == 3 || node.corners[k + 1] == mean_node;
                steps[corner] = is_last ? rest : node.weights[k];
                rest -= steps[corner];
            }
            maker.make(node, steps, hand, has_own);
            rows[i] = maker.terms();
        }
    });
    if (progress.cancelled()) return following_cancelled();
    joiner.join(more, before.grid, tets, bounds);
    before.derived = with_rows(before.derived, rows);
    before.refinement.curved_cells = tets.curved; // its derived points are no centres of polyhedra
    Array user_points(before.grid.points.type(), before.grid.points.data(), before.user_points, 3,
                      std::make_shared<Array>(before.grid.points));
    auto placed = before.extend(user_points);
    if (!placed) return placed.error();
    before.grid.points = *std::move(placed);
    return bounds;
}

std::size_t folded_cells(const Grid& user, const LinearGrid& before, const QuadraticTets& tets,
                         const std::array<NodeValues, 3>& points, std::span<const std::uint32_t> of_tets) {
    std::atomic<std::size_t> folded{0};
    core::parallel_each(of_tets.size(), 16, [&](std::size_t i) {
        OwnCells finder(user, before, tets);
        OwnCell cell;
        finder.find(tets.sources[of_tets[i]], cell);
        if (!cell.functions) {
            const QuadraticTet& tet = tets.tets[of_tets[i]];
            cell.kind = core::CellKind::tetrahedron;
            cell.functions = &own_functions({cell.kind, 2, OwnKind::Of::lagrange});
            cell.nodes.assign(tet.begin(), tet.begin() + 4);
            for (const auto& [a, b] : quadratic_edges(cell.kind)) cell.nodes.push_back(tet[4u + tet_edge_of[a][b]]);
        }
        std::array<std::vector<double>, 3> values;
        for (std::size_t k = 0; k < 3; ++k) cell.values(points[k], values[k]);
        std::vector<double> weights;
        const auto at = [&](const CellPlace& place) {
            cell.functions->weights(place, weights);
            std::array<double, 3> out{};
            for (std::size_t k = 0; k < 3; ++k)
                for (std::size_t n = 0; n < weights.size(); ++n) out[k] += weights[n] * values[k][n];
            return out;
        };
        constexpr std::int64_t steps = 6000, h = 1, side = 6;
        double lowest = INFINITY, highest = -INFINITY;
        for (std::int64_t z = 0; z < side; ++z)
            for (std::int64_t y = 0; y < side; ++y)
                for (std::int64_t x = 0; x < side; ++x) {
                    CellPlace place{{1000 * x + 500, 1000 * y + 500, 1000 * z + 500}, steps};
                    const auto& [u, v, w] = place.at;
                    if (cell.kind == core::CellKind::tetrahedron && u + v + w >= steps) continue;
                    if (cell.kind == core::CellKind::wedge && u + v >= steps) continue;
                    if (cell.kind == core::CellKind::pyramid && (u + w >= steps || v + w >= steps)) continue;
                    std::array<std::array<double, 3>, 3> d{};
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        CellPlace lower = place, upper = place;
                        lower.at[axis] -= h;
                        upper.at[axis] += h;
                        const auto a = at(lower), b = at(upper);
                        for (std::size_t k = 0; k < 3; ++k) d[axis][k] = b[k] - a[k];
                    }
                    const double determinant = d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
                                               d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
                                               d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
                    lowest = std::min(lowest, determinant);
                    highest = std::max(highest, determinant);
                }
        constexpr double rounding = 1e-6; // of differences over so short a way
        const double largest = std::max(std::abs(lowest), std::abs(highest));
        if (lowest < -rounding * largest && highest > rounding * largest) ++folded;
    });
    return folded;
}

} // namespace isotet::linear
