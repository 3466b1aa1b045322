// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/own_pieces.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "base/system/memory.hpp"
#include "linear/curved/own_division.hpp"
#include "linear/curved/own_tets.hpp"

namespace isotet::linear {

namespace {

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

/// Points and their weights in a sum.
using Row = std::vector<std::pair<std::uint64_t, double>>;

/// Of the weights of a new node, of its tet's corners.
std::array<std::uint32_t, 4> steps_on(const QuadraticTet& tet, const PieceNode& node) {
    std::array<std::uint32_t, 4> steps{};
    std::uint32_t rest = whole_weight;
    for (std::size_t k = 0; k < 4 && node.corners[k] != mean_node; ++k) {
        const auto corner = static_cast<std::size_t>(std::ranges::find(tet, node.corners[k]) - tet.begin());
        const bool is_last = k == 3 || node.corners[k + 1] == mean_node;
        steps[corner] = is_last ? rest : node.weights[k];
        rest -= steps[corner];
    }
    return steps;
}

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

    const Row& terms() const { return terms_; }

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
    Row terms_;
};

/// Rows of weights, as many as there are, behind others.
DerivedPoints with_rows(const DerivedPoints& before, const std::vector<Row>& rows) {
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

void raise(std::uint8_t& level, int to) {
    std::atomic_ref shared(level);
    std::uint8_t seen = shared.load(std::memory_order_relaxed);
    while (seen < to && !shared.compare_exchange_weak(seen, static_cast<std::uint8_t>(to), std::memory_order_relaxed)) {
    }
}

/// At the corners of all tets of a cell.
void raise(std::vector<std::uint8_t>& levels, const QuadraticTets& tets, const CellTets& cell, int to) {
    for (std::size_t tet = cell.first; tet < cell.end; ++tet)
        for (std::size_t i = 0; i < 4; ++i) raise(levels[tets.tets[tet][i]], to);
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
            if (level > 0) raise(levels, tets, cells[c], level);
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

/// follow_own_functions(), step by step.
class Follower {
public:
    Follower(const Grid& user, LinearGrid& before, QuadraticTets& tets, const NodeValues& field,
             const std::array<NodeValues, 3>& points, const OwnRule& rule, const Progress& progress)
        : user_(user), before_(before), tets_(tets), field_(field), points_(points), rule_(rule), progress_(progress) {}

    Result<OwnBounds> run();

private:
    void find_levels();
    void find_level(const CellTets& cell, CellAtHand& hand, OwnTet& own, std::size_t number);
    double allowed_length(const CellTets& cell) const;
    Result<void> divide();
    void divide(const CellTets& cell, bool is_curved, CellAtHand& hand, PieceMaker& maker, OwnTet& own,
                TetPieces& out) const;
    Result<void> join();
    std::vector<Row> rows_of(const std::vector<PieceNode>& nodes) const;
    Result<void> add_points(const std::vector<Row>& rows);
    CellAtHand hand() const { return {user_, before_, tets_, field_, points_}; }

    const Grid& user_;
    LinearGrid& before_;
    QuadraticTets& tets_;
    const NodeValues& field_;
    const std::array<NodeValues, 3>& points_;
    const OwnRule& rule_;
    const Progress& progress_;

    const std::uint64_t count_ = before_.grid.points.tuples();
    const std::vector<CellTets> cells_ = tets_by_cell(tets_);
    std::vector<double> expected_ = std::vector<double>(cells_.size(), 0);           ///< of the field, of each cell
    std::vector<std::uint8_t> levels_ = std::vector<std::uint8_t>(count_, 0);        ///< of points
    std::vector<std::uint8_t> curved_ = std::vector<std::uint8_t>(cells_.size(), 0); ///< by places
    std::atomic<bool> differs_{false}, deep_{false}; ///< by more than nothing; than allowed
    std::vector<TetPieces> blocks_;
    std::size_t made_ = 0; ///< pieces
    OwnBounds bounds_;
};

double Follower::allowed_length(const CellTets& cell) const {
    if (rule_.length > 0) return rule_.length;
    double edge = 0;
    for (const NodeValues& axis : points_)
        edge = std::max(edge, std::abs(axis[tets_.tets[cell.first][0]] - axis[tets_.tets[cell.first][1]]));
    return rule_.share * edge;
}

/// `number`   of the cell
void Follower::find_level(const CellTets& cell, CellAtHand& hand, OwnTet& own, std::size_t number) {
    constexpr double negligible = 1.0 / 64;
    const double of_value = hand.value_error_at_most(), of_length = hand.length_error_at_most();
    if (of_value > 0 || of_length > 0) differs_.store(true, std::memory_order_relaxed);
    const bool is_curved = of_length > std::max(negligible * allowed_length(cell), 16 * hand.length_rounding());
    curved_[number] = is_curved;
    std::fill(bounds_.value.begin() + static_cast<std::ptrdiff_t>(cell.first),
              bounds_.value.begin() + static_cast<std::ptrdiff_t>(cell.end), of_value);
    std::fill(bounds_.length.begin() + static_cast<std::ptrdiff_t>(cell.first),
              bounds_.length.begin() + static_cast<std::ptrdiff_t>(cell.end), of_length);
    expected_[number] = of_value;
    if (!is_curved && of_value <= std::max(negligible * rule_.value, 16 * hand.value_rounding())) return;

    LevelFinder finder(hand, {rule_.value, rule_.length, rule_.share});
    int level = 0;
    double most = 0;
    for (std::size_t tet = cell.first; tet < cell.end; ++tet) {
        hand.on_tet(tet, is_curved ? own_fields : 1, own);
        const OwnErrors errors = hand.errors(own);
        bounds_.value[tet] = std::min(of_value, errors.value);
        if (is_curved) bounds_.length[tet] = std::min(of_length, errors.length);
        const auto [needed, left] = finder.find(own, errors);
        level = std::max(level, needed);
        most = std::max(most, std::min(of_value, left.value));
    }
    expected_[number] = most;
    if (level == 0) return;
    deep_.store(true, std::memory_order_relaxed);
    raise(levels_, tets_, cell, level);
}

void Follower::find_levels() {
    bounds_.value.assign(tets_.tets.size(), 0);
    bounds_.length.assign(tets_.tets.size(), 0);
    core::parallel_pieces(cells_.size(), 64, progress_, [&](std::size_t begin, std::size_t end) {
        CellAtHand at_hand = hand();
        OwnTet own;
        for (std::size_t c = begin; c < end; ++c)
            if (at_hand.take(cells_[c].cell) && at_hand.is_finite()) find_level(cells_[c], at_hand, own, c);
    });
    for (const CarriedValues& carried : rule_.carried)
        follow_carried(user_, before_, tets_, cells_, points_, carried, levels_, progress_);
    keep_beside_polyhedra(user_, before_, tets_, levels_);
    if (!rule_.carried.empty() && std::ranges::any_of(levels_, [](std::uint8_t level) { return level > 0; }))
        differs_ = deep_ = true;
}

void Follower::divide(const CellTets& cell, bool is_curved, CellAtHand& hand, PieceMaker& maker, OwnTet& own,
                      TetPieces& out) const {
    const bool has_own = hand.take(cell.cell);
    for (std::size_t tet = cell.first; tet < cell.end; ++tet) {
        if (maker.is_divided(tet)) {
            if (has_own) hand.on_tet(tet, is_curved ? own_fields : 1, own);
            const std::size_t from = out.tets.size();
            maker.divide(tet, has_own ? &own : nullptr, out);
            if (!is_curved)
                for (std::size_t i = from; i < out.tets.size(); ++i) out.length[i] = bounds_.length[tet];
            continue;
        }
        out.tets.push_back(tets_.tets[tet]);
        out.odd.push_back(tets_.odd[tet]);
        out.sources.push_back(cell.cell);
        out.value.push_back(bounds_.value[tet]);
        out.length.push_back(bounds_.length[tet]);
    }
}

Result<void> Follower::divide() {
    constexpr std::size_t cells_per_block = 16;
    constexpr std::uint64_t bytes_per_piece = 1024; // with its share of rows
    blocks_.resize((cells_.size() + cells_per_block - 1) / cells_per_block);
    const std::uint64_t free = core::free_memory();
    std::atomic<std::uint64_t> made{0};
    core::parallel_pieces(blocks_.size(), 4, progress_, [&](std::size_t begin, std::size_t end) {
        CellAtHand at_hand = hand();
        PieceMaker maker(tets_, count_, levels_, rule_, at_hand);
        OwnTet own;
        for (std::size_t b = begin; b < end && made.load() * bytes_per_piece < free; ++b) {
            TetPieces& out = blocks_[b];
            for (std::size_t c = b * cells_per_block; c < std::min(cells_.size(), (b + 1) * cells_per_block); ++c)
                divide(cells_[c], curved_[c] != 0, at_hand, maker, own, out);
            made += out.tets.size();
        }
    });
    if (progress_.cancelled()) return following_cancelled();
    made_ = made;
    if (made_ * bytes_per_piece < free) return {};
    return Error{ErrorCode::out_of_memory,
                 fmt::format("following the cells' own functions takes over {} quadratic tets, the most that {} of "
                             "memory allow: a larger tolerance takes fewer",
                             made_, format_bytes(free))};
}

std::vector<Row> Follower::rows_of(const std::vector<PieceNode>& nodes) const {
    std::vector<Row> rows(nodes.size());
    core::parallel_pieces(nodes.size(), 256, progress_, [&](std::size_t begin, std::size_t end) {
        CellAtHand at_hand = hand();
        RowMaker maker(before_, tets_, count_);
        std::optional<std::uint64_t> cell_at_hand;
        bool has_own = false;
        for (std::size_t i = begin; i < end; ++i) {
            const PieceNode& node = nodes[i];
            if (const std::uint64_t cell = tets_.sources[node.tet]; cell_at_hand != cell) {
                has_own = at_hand.look_at(cell);
                cell_at_hand = cell;
            }
            maker.make(node, steps_on(tets_.tets[node.tet], node), at_hand, has_own);
            rows[i] = maker.terms();
        }
    });
    return rows;
}

Result<void> Follower::add_points(const std::vector<Row>& rows) {
    before_.derived = with_rows(before_.derived, rows);
    before_.refinement.curved_cells = tets_.curved; // its derived points are no centres of polyhedra
    Array user_points(before_.grid.points.type(), before_.grid.points.data(), before_.user_points, 3,
                      std::make_shared<Array>(before_.grid.points));
    auto placed = before_.extend(user_points);
    if (!placed) return placed.error();
    before_.grid.points = *std::move(placed);
    return {};
}

Result<void> Follower::join() {
    PieceJoiner joiner(blocks_, tets_, count_);
    const std::vector<PieceNode> nodes = joiner.number();
    const std::uint64_t more = count_ + nodes.size();
    if (more + tets_.hidden.count() >= max_nodes)
        return Error{ErrorCode::out_of_memory,
                     fmt::format("following the cells' own functions takes {} points, but there may be at most {}: a "
                                 "larger tolerance takes fewer",
                                 more, max_nodes)};
    const std::vector<Row> rows = rows_of(nodes);
    if (progress_.cancelled()) return following_cancelled();
    joiner.join(more, before_.grid, tets_, bounds_);
    return add_points(rows);
}

Result<OwnBounds> Follower::run() {
    find_levels();
    if (progress_.cancelled()) return following_cancelled();
    if (!differs_) return OwnBounds{};
    bounds_.expected = expected_.empty() ? 0 : *std::ranges::max_element(expected_);
    if (!deep_) return std::move(bounds_);
    if (Result<void> divided = divide(); !divided) return divided.error();
    if (made_ == 0) { // no isovalue is met: what contours takes no grid without cells
        bounds_.value.assign(tets_.tets.size(), 0);
        bounds_.length.assign(tets_.tets.size(), 0);
        return std::move(bounds_);
    }
    if (Result<void> joined = join(); !joined) return joined.error();
    return std::move(bounds_);
}

} // namespace

Result<OwnBounds> follow_own_functions(const Grid& user, LinearGrid& before, QuadraticTets& tets,
                                       const NodeValues& field, const std::array<NodeValues, 3>& points,
                                       const OwnRule& rule, const Progress& progress) {
    return Follower(user, before, tets, field, points, rule, progress).run();
}

} // namespace isotet::linear
