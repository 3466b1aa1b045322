// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Ordered bisection of quadratic tets: which edge is bisected next follows from the edges alone, so neighbours agree.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <isotet/progress.hpp>

#include "base/buffer.hpp"
#include "linear/curved/distance.hpp"
#include "linear/curved/node_values.hpp"
#include "linear/curved/quadratic.hpp"
#include "linear/place.hpp"

namespace isotet::linear {

/// A field for which edges are bisected, too, down to a quarter of a tet's.
struct CarriedValues {
    NodeValues values;
    double deviation = 0; ///< as BisectionRule::deviation; 0: it is constant, and not looked at
};

struct BisectionRule {
    bool nodes_only = false; ///< bisect just the edges that have nodes; fields are not looked at
    double deviation = 0;    ///< an edge is bisected where its middle is farther than this from the mean of its ends
    double length = 0;       ///< the same for places; 0: by `bend`
    double bend = 0.01;      ///< the same for places, in lengths of the edge, for new points in steps of 1/64
    std::span<const double> deviations = {}; ///< empty, or one a point: at an edge the lesser of its ends' holds, too;
                                             ///< between points they are linear
    std::span<const double> isovalues;       ///< ascending; tets that none can meet are dropped; empty: none is
    std::span<const CarriedValues> carried = {};
};

/// What has become of some quadratic tets.
struct Bisected {
    core::Buffer<Place> places;                      ///< of points, each once in a quadratic tet
    core::Buffer<std::uint32_t> parents;             ///< of points, the quadratic tet
    core::Buffer<std::array<std::uint32_t, 4>> tets; ///< points
    core::Buffer<std::uint32_t> children;            ///< tets of each quadratic tet, in order
    double deviation = 0, length2 = 0;               ///< largest that are left at an edge; of places, squared
    std::uint64_t not_finite = 0;                    ///< quadratic tets dropped
    bool too_fine = false;                           ///< an edge was too short to be bisected further
    DistanceCounts distances;                        ///< with BisectionRule::deviations
    std::vector<std::uint32_t> bent;                 ///< quadratic tets of which an edge bends by more than `bend`, but is
                                                     ///< too short for that
};

/// Limits that all threads share.
struct BisectionLimits {
    std::uint64_t max_tets = 0;
    std::atomic<std::uint64_t> tets{0};
    std::atomic<bool> exceeded{false};
};

/// Bisects one quadratic tet after another. Borrows all it is given.
class Bisector {
public:
    Bisector(const QuadraticTets& grid, const std::array<NodeValues, 3>& points, const NodeValues* field,
             const BisectionRule& rule, BisectionLimits& limits, const Progress& progress);

    /// Adds the tets that quadratic tet `index` becomes.
    /// Returns how many tets it made.
    std::size_t bisect(std::uint32_t index);

    /// As a quadratic tet of which nothing is kept.
    void pass_over() { children_.push_back(0); }
    /// Adds a tet of points of it that have not all a value, as not all of its nodes have.
    void keep_whole(std::uint32_t index);
    /// What has been added since the last call.
    Bisected take();

private:
    /// What all tets at an edge know of it. A quadratic field is at the middle of an edge by `bump` above the mean of its
    /// ends, and places by `bend`.
    struct Edge {
        double bump = 0;
        std::array<double, 3> bend{};
        double length2 = 0;
        int grade = unmarked;
    };
    struct Corner {
        double value = 0, deviation = 0;
        std::array<double, 3> at{};
        Place place{};
    };
    struct Part {
        std::array<Corner, 4> corners;
        std::array<Edge, 6> edges;
    };
    static constexpr int unmarked = -1, no_edge = 6;

    Part part_of(std::uint32_t index);
    double distance_in(const Part& part) const;
    bool can_be_met(double lower, double upper) const;
    bool is_met(const Part& part) const;
    static bool is_constant(const Part& part);
    double carried_excess(const Place& a, const Place& b) const;
    void judge(Edge& edge, const Corner& a, const Corner& b);
    std::size_t first_marked(const Part& part);
    void divide(const Part& part);
    void emit(const Part& part);
    std::uint32_t number_of(const Place& place);
    void forget_numbers();
    void order_points(std::size_t first_point, std::size_t first_tet);

    const QuadraticTets& grid_;
    const std::array<NodeValues, 3>& points_;
    const NodeValues* field_;
    const BisectionRule& rule_;
    BisectionLimits& limits_;
    const Progress& progress_;
    double per_deviation_;
    std::vector<std::array<double, 10>>
        carried_; ///< of the tet at hand: Bezier values over the deviation that is allowed
    std::uint32_t index_ = 0;
    std::uint64_t uncounted_ = 0;
    bool stopped_ = false;

    // What take() gives away.
    std::vector<Place> places_;
    std::vector<std::uint32_t> parents_;
    std::vector<std::array<std::uint32_t, 4>> tets_;
    std::vector<std::uint32_t> children_;
    Bisected told_;

    std::vector<Place> slots_; ///< hash of the places of the tet at hand
    std::vector<std::uint32_t> slot_numbers_;
    std::uint64_t used_slots_ = 0;
    std::vector<std::pair<Place, std::uint32_t>> order_;
    std::vector<std::uint32_t> rank_;
};

} // namespace isotet::linear
