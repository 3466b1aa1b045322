// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Quadratic tets in pieces, and the points that these have in common.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "linear/curved/own_pieces.hpp"
#include "linear/curved/own_tets.hpp"
#include "linear/curved/quadratic.hpp"
#include "linear/place.hpp"

namespace isotet::linear {

/// What all tets at a new point know of it; `tet` and `local` are where one of them has it.
struct PieceNode {
    std::array<Node, 4> corners; ///< those that weigh something; then mean_node
    std::array<std::uint32_t, 3> weights;
    std::uint32_t tet, local;

    bool is_same(const PieceNode& other) const { return corners == other.corners && weights == other.weights; }
    auto operator<=>(const PieceNode&) const = default;
};

constexpr std::uint32_t new_node = 1u << 31; ///< of the nodes of a block

struct TetPieces {
    std::vector<QuadraticTet> tets; ///< nodes as before, or new_node and a number in `nodes`
    std::vector<std::uint8_t> odd;
    std::vector<std::uint64_t> sources;
    std::vector<double> value, length;
    std::vector<PieceNode> nodes;
};

/// Divides tets at their marked edges, and leaves out pieces that no isovalue meets.
class PieceMaker {
public:
    PieceMaker(const QuadraticTets& tets, std::uint64_t points, const std::vector<std::uint8_t>& levels,
               const OwnRule& rule, CellAtHand& at_hand)
        : tets_(tets), points_(points), levels_(levels), rule_(rule), hand_(at_hand) {}

    /// True when some edge of a tet is marked.
    bool is_divided(std::size_t tet) const;

    /// `own`   null: the quadratic functions of the tet are the cell's
    void divide(std::size_t tet, const OwnTet* own, TetPieces& out);

private:
    struct Part {
        std::array<Place, 4> at;
        OwnTet own;
    };

    std::size_t first_marked(const Part& part) const;
    bool can_be_met(double lower, double upper) const;
    void divide(const Part& part, bool has_own);
    void emit(const Part& part, bool has_own);
    Node corner_node(const Place& place);
    /// Whole edges of the tet keep their middles, also those that are no points.
    Node middle_node(const Place& a, const Place& b);

    const QuadraticTets& tets_;
    std::uint64_t points_;
    const std::vector<std::uint8_t>& levels_;
    const OwnRule& rule_;
    CellAtHand& hand_;
    std::size_t tet_ = 0;
    TetPieces* out_ = nullptr;
    std::map<Place, Node> local_;
};

/// The pieces of all blocks with new points numbered.
class PieceJoiner {
public:
    PieceJoiner(std::vector<TetPieces>& blocks, const QuadraticTets& tets, std::uint64_t points)
        : blocks_(blocks), tets_(tets), points_(points) {}

    /// Returns one of each new point, in the order of their numbers.
    std::vector<PieceNode> number();

    /// `more`   how many points there are now
    void join(std::uint64_t more, const Grid& grid, QuadraticTets& out, OwnBounds& bounds);

private:
    std::vector<TetPieces>& blocks_;
    const QuadraticTets& tets_;
    std::uint64_t points_;
    std::vector<std::size_t> first_;
    std::vector<Node> numbers_;
};

} // namespace isotet::linear
