// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdlib>
#include <numeric>
#include <optional>
#include <span>

#include "linear/curved/high_degree.hpp"
#include "linear/curved/pyramid_weights.hpp"

namespace isotet::linear {

namespace {

using Whole = std::int64_t;

/// num / den, rounded once: equal numbers have equal bits.
double rounded(Whole numerator, Whole denominator) {
    const Whole common = std::gcd(numerator, denominator);
    return static_cast<double>(static_cast<long double>(numerator / common) /
                               static_cast<long double>(denominator / common));
}

/// The weight of node `node` of a simplex of degree p at `at` / l; both are barycentric: their sums are p and l. Up to degree
/// 10 all products fit into 63 bits.
double simplex_weight(std::span<const Whole> node, std::span<const Whole> at, Whole p, Whole l, bool bezier) {
    Whole numerator = 1, denominator = 1, chosen = 0;
    for (std::size_t k = 0; k < node.size(); ++k)
        for (Whole m = 0; m < node[k]; ++m) {
            if (bezier) {
                numerator *= at[k];
                denominator *= l;
                continue;
            }
            numerator *= p * at[k] - m * l;
            denominator *= (node[k] - m) * l;
        }
    if (!bezier) return rounded(numerator, denominator);
    for (const Whole count : node) // the multinomial coefficient
        for (Whole m = 1; m <= count; ++m) numerator = numerator * ++chosen / m;
    return rounded(numerator, denominator);
}

double line_weight(Whole node, Whole at, Whole p, Whole l, bool bezier) {
    return simplex_weight(std::array{p - node, node}, std::array{l - at, at}, p, l, bezier);
}

/// On a face of a pyramid: of the face alone, as in the cell beside it.
double pyramid_face_weight(Whole p, const core::LatticePlace& n, const core::LatticePlace& x, Whole l) {
    const auto triangle = [&](bool has_node, std::size_t axis) {
        if (!has_node) return 0.0;
        return simplex_weight(std::array<Whole, 3>{p - n[axis] - n[2], n[axis], n[2]},
                              std::array<Whole, 3>{l - x[axis] - x[2], x[axis], x[2]}, p, l, false);
    };
    if (x[2] == 0) return n[2] == 0 ? line_weight(n[0], x[0], p, l, false) * line_weight(n[1], x[1], p, l, false) : 0;
    for (const std::size_t axis : {0, 1}) {
        const std::size_t along = 1 - axis;
        if (x[axis] == 0) return triangle(n[axis] == 0, along);
        if (x[axis] + x[2] == l) return triangle(n[axis] + n[2] == p, along);
    }
    return 0;
}

bool is_inside_pyramid(const core::LatticePlace& x, int l) {
    return x[0] > 0 && x[1] > 0 && x[2] > 0 && x[0] + x[2] < l && x[1] + x[2] < l;
}

double node_weight(const HighDegree& cell, const core::LatticePlace& n, const core::LatticePlace& x, Whole l) {
    const Whole p = cell.degree;
    switch (cell.kind) {
    case core::CellKind::tetrahedron:
        return simplex_weight(std::array<Whole, 4>{p - n[0] - n[1] - n[2], n[0], n[1], n[2]},
                              std::array<Whole, 4>{l - x[0] - x[1] - x[2], x[0], x[1], x[2]}, p, l, cell.bezier);
    case core::CellKind::wedge:
        return simplex_weight(std::array<Whole, 3>{p - n[0] - n[1], n[0], n[1]},
                              std::array<Whole, 3>{l - x[0] - x[1], x[0], x[1]}, p, l, cell.bezier) *
               line_weight(n[2], x[2], p, l, cell.bezier);
    case core::CellKind::pyramid: return pyramid_face_weight(p, n, x, l);
    case core::CellKind::hexahedron: break;
    }
    return line_weight(n[0], x[0], p, l, cell.bezier) * line_weight(n[1], x[1], p, l, cell.bezier) *
           line_weight(n[2], x[2], p, l, cell.bezier);
}

/// A corner of the coarse lattice, of `along` steps an edge.
using Coarse = std::array<int, 3>;

class PlanMaker {
public:
    explicit PlanMaker(const HighDegree& cell)
        : cell_(cell),
          along_(static_cast<int>((cell.degree + 1) / 2)),
          fine_(2 * along_),
          nodes_(core::nodes_of_degree(cell.kind, cell.degree, core::NodeOrder::vtk)) {}

    DegreePlan make() {
        if (cell_.degree == 1) return linear_cell();
        const auto side = static_cast<std::size_t>(fine_ + 1);
        plan_.rows.resize(side * side * side);
        for (int z = 0; z < along_; ++z)
            for (int y = 0; y < along_; ++y)
                for (int x = 0; x < along_; ++x) add_cells({x, y, z});
        return std::move(plan_);
    }

private:
    DegreePlan linear_cell() {
        static constexpr std::array<std::uint8_t, core::cell_kind_count> types{10, 14, 13, 12};
        DegreePlan::Cell cell{types[static_cast<std::size_t>(cell_.kind)], {}};
        for (std::uint16_t i = 0; i < core::corner_count(cell_.kind); ++i) {
            plan_.rows.push_back({{i, 1.0}});
            cell.places.push_back(i);
        }
        plan_.cells.push_back(std::move(cell));
        return std::move(plan_);
    }

    std::uint32_t place(int x, int y, int z) {
        const auto index = static_cast<std::uint32_t>(x + (fine_ + 1) * (y + (fine_ + 1) * z));
        DegreePlan::Terms& row = plan_.rows[index];
        if (!row.empty()) return index;
        const core::LatticePlace at{static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y),
                                    static_cast<std::uint16_t>(z)};
        std::vector<double> weights(nodes_.size());
        if (cell_.kind == core::CellKind::pyramid && is_inside_pyramid(at, fine_)) weights = weights_inside(at);
        else
            for (std::size_t i = 0; i < nodes_.size(); ++i) weights[i] = node_weight(cell_, nodes_[i], at, fine_);
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            if (weights[i] != 0) row.emplace_back(static_cast<std::uint16_t>(i), weights[i]);
        return index;
    }

    std::vector<double> weights_inside(const core::LatticePlace& at) {
        if (cell_.degree % 2) {
            if (!inside_) inside_.emplace(cell_.degree);
            return inside_->at(at, static_cast<unsigned>(fine_));
        }
        std::vector<double> weights(nodes_.size());
        for (std::size_t i = 0; i < nodes_.size(); ++i) weights[i] = nodes_[i] == at;
        return weights;
    }

    void add_cells(const Coarse& at) {
        const int flat = at[0] + at[1];
        switch (cell_.kind) {
        case core::CellKind::tetrahedron: return add_tets(at);
        case core::CellKind::wedge:
            if (flat < along_) add_shape(at, 1, 32);
            if (flat < along_ - 1) add_shape({at[0] + 1, at[1] + 1, at[2]}, -1, 32);
            return;
        case core::CellKind::pyramid: return add_pyramids(at);
        case core::CellKind::hexahedron: break;
        }
        add_shape(at, 1, 29);
    }

    /// `sense`   -1: turned by half a turn about the third axis
    void add_shape(const Coarse& at, int sense, std::uint8_t type) {
        DegreePlan::Cell cell{type, {}};
        for (const auto& [u, v, w] : core::nodes_of_degree(cell_.kind, 2, core::NodeOrder::vtk))
            cell.places.push_back(place(2 * at[0] + sense * u, 2 * at[1] + sense * v, 2 * at[2] + w));
        plan_.cells.push_back(std::move(cell));
    }

    /// A tetrahedron, an octahedron in four, and a tetrahedron upside down: as far as they lie in the cell.
    void add_tets(const Coarse& at) {
        const auto corner = [&](int x, int y, int z) { return Coarse{at[0] + x, at[1] + y, at[2] + z}; };
        const int level = at[0] + at[1] + at[2];
        if (level < along_) add_tet({corner(0, 0, 0), corner(1, 0, 0), corner(0, 1, 0), corner(0, 0, 1)});
        if (level < along_ - 1) {
            const std::array<Coarse, 5> ring{corner(0, 1, 0), corner(1, 1, 0), corner(1, 0, 1), corner(0, 0, 1),
                                             corner(0, 1, 0)};
            for (std::size_t i = 0; i < 4; ++i) add_tet({corner(1, 0, 0), corner(0, 1, 1), ring[i], ring[i + 1]});
        }
        if (level < along_ - 2) add_tet({corner(1, 1, 1), corner(0, 1, 1), corner(1, 0, 1), corner(1, 1, 0)});
    }

    /// A pyramid, one upside down between four such, and tets between two: as far as they lie in the cell.
    void add_pyramids(const Coarse& at) {
        const auto corner = [&](int x, int y, int z) { return Coarse{at[0] + x, at[1] + y, at[2] + z}; };
        const int left = along_ - at[2];
        const bool x_first = at[0] < left, x_again = at[0] < left - 1, y_first = at[1] < left,
                   y_again = at[1] < left - 1;
        if (x_first && y_first)
            add_pyramid({corner(0, 0, 0), corner(1, 0, 0), corner(1, 1, 0), corner(0, 1, 0), corner(0, 0, 1)});
        if (x_again && y_again)
            add_pyramid({corner(0, 0, 1), corner(0, 1, 1), corner(1, 1, 1), corner(1, 0, 1), corner(1, 1, 0)});
        if (x_again && y_first) add_tet({corner(1, 0, 0), corner(1, 1, 0), corner(0, 0, 1), corner(1, 0, 1)});
        if (x_first && y_again) add_tet({corner(0, 1, 0), corner(1, 1, 0), corner(0, 0, 1), corner(0, 1, 1)});
    }

    void add_pyramid(const std::array<Coarse, 5>& c) {
        DegreePlan::Cell cell{74, {}};
        for (const Coarse& corner : c) cell.places.push_back(between(corner, corner));
        for (const auto& [a, b] : quadratic_edges(core::CellKind::pyramid)) cell.places.push_back(between(c[a], c[b]));
        cell.places.push_back(between(c[0], c[2]));
        plan_.cells.push_back(std::move(cell));
    }

    std::uint32_t between(const Coarse& a, const Coarse& b) { return place(a[0] + b[0], a[1] + b[1], a[2] + b[2]); }

    void add_tet(std::array<Coarse, 4> c) {
        std::array<Coarse, 3> e{};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) e[i][k] = c[i + 1][k] - c[0][k];
        const int volume = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                           e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                           e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
        if (volume < 0) std::swap(c[2], c[3]);
        DegreePlan::Cell cell{24, {}};
        for (const Coarse& corner : c) cell.places.push_back(between(corner, corner));
        for (const auto& [a, b] : quadratic_edges(core::CellKind::tetrahedron))
            cell.places.push_back(between(c[a], c[b]));
        plan_.cells.push_back(std::move(cell));
    }

    HighDegree cell_;
    int along_, fine_;
    std::vector<core::LatticePlace> nodes_;
    std::optional<PyramidWeights> inside_;
    DegreePlan plan_;
};

} // namespace

DegreePlan plan_of(const HighDegree& cell) { return PlanMaker(cell).make(); }

} // namespace isotet::linear
