// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A cell's own functions: polynomials of its coordinates, of pyramids quotients of such.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <isotet/export.hpp>

#include "grid/cell/node_order.hpp"
#include "linear/curved/bernstein.hpp"
#include "linear/curved/pyramid_weights.hpp"

namespace isotet::linear {

/// Which functions the nodes of a cell have. Cells of degree 2 have all nodes of their kind here: those that they lack
/// are weighted sums of others.
struct OwnKind {
    core::CellKind kind;
    unsigned degree;
    enum class Of : std::uint8_t { lagrange, bezier } of = Of::lagrange;

    auto operator<=>(const OwnKind&) const = default;
};

/// Coordinates in a cell, over a common denominator: as core::LatticePlace over the degree.
struct CellPlace {
    std::array<std::int64_t, 3> at;
    std::int64_t steps;
};

/// The functions of a kind. The space is that of products of polynomials of degree p, one on each *factor*: a tetrahedron; a
/// triangle and a line; three lines. A pyramid is three lines, of x / (1 - z), y / (1 - z) and z. Its *net* are the Bernstein
/// coefficients there.
class ISOTET_API OwnFunctions {
public:
    explicit OwnFunctions(const OwnKind& kind);

    std::size_t nodes() const { return nodes_.size(); }
    std::size_t net_size() const { return net_size_; }
    bool is_rational() const { return kind_.kind == core::CellKind::pyramid; }
    /// Of the polynomials that tets inside have.
    unsigned bernstein_degree() const { return static_cast<unsigned>(factors_.size()) * kind_.degree; }

    /// What the nodes weigh at a place; those that have no part of it are 0.
    void weights(const CellPlace& place, std::vector<double>& out) const;

    /// `values`   at the nodes
    void net(std::span<const double> values, std::vector<double>& out) const;
    /// How much larger rounding of values may be in the net.
    double net_norm() const { return net_norm_; }

    /// Every polynomial of degree 2 of the coordinates, on any tet, differs from the function by at least a share of this;
    /// the interpolant by at most this.
    double error_at_most(std::span<const double> net) const;

    /// What on_tet() needs of a tet.
    struct Tet {
        std::vector<std::vector<double>> factors; ///< values_on_tet()
        std::vector<double> bottom;               ///< the denominator of quotients; empty: 1
    };
    Tet tet(const std::array<CellPlace, 4>& corners) const;
    /// The coefficients of the function on a tet; of a quotient those of its numerator.
    void on_tet(std::span<const double> net, const Tet& tet, std::vector<double>& out) const;

private:
    struct Factor {
        std::size_t dimension;
        std::vector<std::array<std::uint8_t, 4>> indices; ///< of its functions
        std::vector<double> to_bernstein;                 ///< from values at lattice points
    };

    Factor factor_of(std::size_t dimension) const;
    std::array<double, 4> forms(std::size_t factor, const CellPlace& at) const;
    std::vector<double> values_on_tet(std::size_t factor, const std::array<CellPlace, 4>& corners) const;
    void apply_factors(std::vector<double>& values, std::size_t columns) const;
    CellPlace grid_place(std::size_t at) const;

    OwnKind kind_;
    std::vector<core::LatticePlace> nodes_;
    std::vector<Factor> factors_;
    std::optional<PyramidWeights> pyramid_;
    std::size_t net_size_ = 1;
    std::vector<double> to_net_; ///< net x nodes
    double net_norm_ = 1;
    std::vector<double> quadratics_; ///< net x 10: orthonormal nets of the polynomials of degree 2
};

/// Made at the first call; safe from many threads.
const OwnFunctions& own_functions(const OwnKind& kind);

} // namespace isotet::linear
