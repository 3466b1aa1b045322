// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The own functions of cells on tets: how far they are from quadratic ones, and how often tets must be halved.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/linear_cells.hpp>

#include "linear/curved/node_values.hpp"
#include "linear/curved/own_cell.hpp"
#include "linear/curved/quadratic.hpp"
#include "linear/place.hpp"

namespace isotet::linear {

constexpr std::size_t own_fields = 4; ///< the field, then x, y, z
constexpr int most_halvings = 6;      ///< of an edge

/// Four polynomials on a tet: the field, x, y and z; of these only the field where the cell is what its tets are.
struct OwnTet {
    std::array<std::vector<double>, own_fields> top;
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
    bool take(std::uint64_t cell);

    bool is_finite() const { return finite_; }
    const OwnCell& cell() const { return cell_; }
    std::array<CellPlace, 4> corners(std::size_t tet) const;

    /// In all the cell, without a look at its tets.
    double value_error_at_most() const { return cell_.functions->error_at_most(nets_[0]) + rounding_[0]; }
    double value_rounding() const { return rounding_[0]; }
    double length_rounding() const { return std::max({rounding_[1], rounding_[2], rounding_[3]}); }
    double length_error_at_most() const;

    void on_tet(std::size_t tet, std::size_t count, OwnTet& out);

    OwnErrors errors(const OwnTet& tet) const;

private:
    using Key = std::pair<const OwnFunctions*, std::array<std::int64_t, 12>>;

    OwnCells cells_;
    const QuadraticTets& tets_;
    std::array<const NodeValues*, own_fields> of_;
    OwnCell cell_;
    bool finite_ = true;
    std::vector<double> values_;
    std::array<std::vector<double>, own_fields> nets_;
    std::array<double, own_fields> rounding_{};
    std::map<Key, OwnFunctions::Tet> known_;
};

/// Of the marked edges the longest, ties by the places of the ends; 6: none. `is_marked` gives the square of the length, or
/// nothing.
std::size_t longest_marked_edge(const std::array<Place, 4>& at, const auto& is_marked) {
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

struct WeightChange {
    std::uint32_t largest = 0; ///< of a weight
    double squares = 0;
};

WeightChange change_between(const Place& a, const Place& b);

/// Both halves of a tet.
void halve(unsigned degree, std::size_t edge, const OwnTet& whole, OwnTet& first, OwnTet& second);

/// What the error of a tet may be.
struct AllowedErrors {
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
    LevelFinder(const CellAtHand& hand, const AllowedErrors& allowed) : hand_(hand), allowed_(allowed) {}

    std::pair<int, OwnErrors> find(const OwnTet& tet, const OwnErrors& errors, int most = most_halvings);

private:
    void divide(const std::array<Place, 4>& at, const OwnTet& tet);

    const CellAtHand& hand_;
    AllowedErrors allowed_;
    OwnTet worst_;
    OwnErrors errors_;
    double most_ = -1;
};

} // namespace isotet::linear
