// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polynomials on a tet by Bernstein coefficients: halves, products, and how far one is from its quadratic interpolant.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <isotet/export.hpp>

namespace isotet::linear {

/// How often each corner counts; the sum is the degree.
using TetIndex = std::array<std::uint8_t, 4>;

inline constexpr unsigned max_bernstein_degree = 32; ///< three times the highest degree of a cell, and 2

/// The coefficients of one degree, and what is worth knowing of them beforehand.
class BernsteinTable {
public:
    explicit BernsteinTable(unsigned degree);

    unsigned degree() const { return degree_; }
    std::size_t count() const { return indices_.size(); }
    const TetIndex& operator[](std::size_t i) const { return indices_[i]; }
    std::size_t find(const TetIndex& index) const {
        return numbers_[(index[1] * (degree_ + 1) + index[2]) * (degree_ + 1) + index[3]];
    }
    double multinomial(std::size_t i) const { return multinomials_[i]; }

    /// Coefficients that differ in how often the ends of an edge count alone: by the second end, ascending.
    std::span<const std::vector<std::uint32_t>> rows(std::size_t edge) const { return rows_[edge]; }
    /// The one from end to end.
    const std::vector<std::uint32_t>& row_of_edge(std::size_t edge) const { return rows_[edge][whole_row_[edge]]; }

    /// What the ten Bezier values of a quadratic polynomial weigh in a coefficient of this degree.
    const std::array<double, 10>& quadratic_weights(std::size_t i) const { return quadratic_[i]; }

private:
    unsigned degree_;
    std::vector<TetIndex> indices_;
    std::vector<std::uint32_t> numbers_;
    std::vector<double> multinomials_;
    std::array<std::vector<std::vector<std::uint32_t>>, 6> rows_;
    std::array<std::size_t, 6> whole_row_{};
    std::vector<std::array<double, 10>> quadratic_;
};

/// Up to max_bernstein_degree; made at the first call.
const BernsteinTable& bernstein_table(unsigned degree);

/// Coefficient `to` of a product has `weight` times coefficient `a` of the first and `b` of the second factor.
struct ProductTerm {
    std::uint32_t a, b, to;
    double weight;
};
/// Made at the first call.
const std::vector<ProductTerm>& product_terms(unsigned degree_a, unsigned degree_b);

/// A polynomial, or the quotient of two: `bottom` empty is 1, else positive, but for coefficients that are 0 where those
/// of `top` are, too.
struct Quotient {
    std::vector<double> top, bottom;
};

/// The halves of a tet, bisected at an edge: with its first end, and with its second.
void halve(const BernsteinTable& table, std::size_t edge, std::span<const double> whole, std::vector<double>& first,
           std::vector<double>& second);

struct QuadraticPart {
    std::array<double, 10> bezier{}; ///< of the interpolant at corners and middles of edges
    double lower = 0, upper = 0;     ///< of all values in the tet
    double error = 0;                ///< largest difference of the interpolant, without rounding
};

QuadraticPart quadratic_part(unsigned degree, std::span<const double> top, std::span<const double> bottom);

/// Least and largest value that there can be.
std::array<double, 2> hull(unsigned degree, std::span<const double> top, std::span<const double> bottom);

} // namespace isotet::linear
