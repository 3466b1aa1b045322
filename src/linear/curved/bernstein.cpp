// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/bernstein.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>

#include "linear/curved/quadratic.hpp"

namespace isotet::linear {

namespace {

std::vector<double> factorials() {
    std::vector<double> out{1};
    for (unsigned i = 1; i <= max_bernstein_degree; ++i) out.push_back(out.back() * i);
    return out;
}

const std::vector<double>& factorial() {
    static const std::vector<double> all = factorials();
    return all;
}

} // namespace

BernsteinTable::BernsteinTable(unsigned degree) : degree_(degree) {
    const unsigned n = degree;
    numbers_.assign(std::size_t{n + 1} * (n + 1) * (n + 1), 0);
    for (unsigned a = 0; a <= n; ++a)
        for (unsigned b = 0; a + b <= n; ++b)
            for (unsigned c = 0; a + b + c <= n; ++c) {
                numbers_[(a * (n + 1) + b) * (n + 1) + c] = static_cast<std::uint32_t>(indices_.size());
                indices_.push_back({static_cast<std::uint8_t>(n - a - b - c), static_cast<std::uint8_t>(a),
                                    static_cast<std::uint8_t>(b), static_cast<std::uint8_t>(c)});
            }
    const auto& f = factorial();
    for (const TetIndex& index : indices_) {
        double value = f[n];
        for (const std::uint8_t k : index) value /= f[k];
        multinomials_.push_back(std::round(value));
        std::array<double, 10> weights{};
        const double pairs = n > 1 ? static_cast<double>(n) * (n - 1) : 1;
        for (std::size_t i = 0; i < 4; ++i) weights[i] = static_cast<double>(index[i]) * (index[i] - 1) / pairs;
        for (std::size_t e = 0; e < 6; ++e)
            weights[4 + e] = 2.0 * index[tet_edges[e][0]] * index[tet_edges[e][1]] / pairs;
        quadratic_.push_back(weights);
    }
    for (std::size_t e = 0; e < 6; ++e) {
        const auto [a, b] = tet_edges[e];
        for (const TetIndex& index : indices_) {
            if (index[b] != 0) continue; // a row begins where the second end does not count
            std::vector<std::uint32_t> row;
            TetIndex at = index;
            for (unsigned k = 0; k <= index[a]; ++k) {
                at[a] = static_cast<std::uint8_t>(index[a] - k);
                at[b] = static_cast<std::uint8_t>(k);
                row.push_back(static_cast<std::uint32_t>(find(at)));
            }
            if (index[a] == n) whole_row_[e] = rows_[e].size();
            rows_[e].push_back(std::move(row));
        }
    }
}

const BernsteinTable& bernstein_table(unsigned degree) {
    static std::array<std::unique_ptr<const BernsteinTable>, max_bernstein_degree + 1> tables;
    static std::array<std::once_flag, max_bernstein_degree + 1> once;
    std::call_once(once[degree], [&] { tables[degree] = std::make_unique<const BernsteinTable>(degree); });
    return *tables[degree];
}

const std::vector<ProductTerm>& product_terms(unsigned degree_a, unsigned degree_b) {
    constexpr std::size_t side = max_bernstein_degree + 1;
    static std::array<std::unique_ptr<const std::vector<ProductTerm>>, side * side> all;
    static std::array<std::once_flag, side * side> once;
    const std::size_t key = degree_a * side + degree_b;
    std::call_once(once[key], [&] {
        const BernsteinTable &a = bernstein_table(degree_a), &b = bernstein_table(degree_b),
                             &to = bernstein_table(degree_a + degree_b);
        std::vector<ProductTerm> terms;
        for (std::size_t i = 0; i < a.count(); ++i)
            for (std::size_t j = 0; j < b.count(); ++j) {
                TetIndex sum = a[i];
                for (std::size_t k = 0; k < 4; ++k) sum[k] = static_cast<std::uint8_t>(sum[k] + b[j][k]);
                const std::size_t at = to.find(sum);
                terms.push_back({static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(j),
                                 static_cast<std::uint32_t>(at),
                                 a.multinomial(i) * b.multinomial(j) / to.multinomial(at)});
            }
        all[key] = std::make_unique<const std::vector<ProductTerm>>(std::move(terms));
    });
    return *all[key];
}

void halve(const BernsteinTable& table, std::size_t edge, std::span<const double> whole, std::vector<double>& first,
           std::vector<double>& second) {
    first.resize(whole.size());
    second.resize(whole.size());
    std::array<double, max_bernstein_degree + 1> value{};
    for (const auto& row : table.rows(edge)) {
        const std::size_t last = row.size() - 1;
        for (std::size_t k = 0; k <= last; ++k) value[k] = whole[row[k]];
        first[row[0]] = value[0];
        second[row[last]] = value[last];
        for (std::size_t step = 1; step <= last; ++step) { // de Casteljau
            for (std::size_t k = 0; k + step <= last; ++k) value[k] = (value[k] + value[k + 1]) / 2;
            first[row[step]] = value[0];
            second[row[last - step]] = value[last - step];
        }
    }
}

std::array<double, 2> hull(unsigned degree, std::span<const double> top, std::span<const double> bottom) {
    if (bottom.empty()) {
        const auto [lower, upper] = std::ranges::minmax(top);
        return {lower, upper};
    }
    const BernsteinTable& table = bernstein_table(degree);
    double lower = INFINITY, upper = -INFINITY;
    for (std::size_t i = 0; i < table.count(); ++i) {
        if (bottom[i] == 0) continue;
        const double value = top[i] / bottom[i];
        lower = std::min(lower, value);
        upper = std::max(upper, value);
    }
    return {lower, upper};
}

namespace {

double at_middle(const std::vector<std::uint32_t>& row, std::span<const double> values) {
    std::array<double, max_bernstein_degree + 1> value{};
    for (std::size_t k = 0; k < row.size(); ++k) value[k] = values[row[k]];
    for (std::size_t step = 1; step < row.size(); ++step)
        for (std::size_t k = 0; k + step < row.size(); ++k) value[k] = (value[k] + value[k + 1]) / 2;
    return value[0];
}

} // namespace

QuadraticPart quadratic_part(unsigned degree, std::span<const double> top, std::span<const double> bottom) {
    const BernsteinTable& table = bernstein_table(degree);
    QuadraticPart part;
    for (std::size_t i = 0; i < 4; ++i) {
        TetIndex corner{};
        corner[i] = static_cast<std::uint8_t>(degree);
        const std::size_t at = table.find(corner);
        part.bezier[i] = top[at];
    }
    for (std::size_t e = 0; e < 6; ++e) {
        const auto& row = table.row_of_edge(e);
        double middle = at_middle(row, top);
        if (!bottom.empty()) middle /= at_middle(row, bottom);
        part.bezier[4 + e] = middle;
    }
    if (!bottom.empty())
        for (std::size_t i = 0; i < 4; ++i) {
            TetIndex corner{};
            corner[i] = static_cast<std::uint8_t>(degree);
            const std::size_t at = table.find(corner);
            if (bottom[at] != 0) {
                part.bezier[i] = top[at] / bottom[at];
                continue;
            }
            // Both vanish there, as at the apex of a pyramid: the limit is that of the coefficients nearest to the corner.
            std::size_t best = at;
            int most = -1;
            for (std::size_t k = 0; k < table.count(); ++k)
                if (bottom[k] != 0 && static_cast<int>(table[k][i]) > most) {
                    most = table[k][i];
                    best = k;
                }
            part.bezier[i] = top[best] / bottom[best];
        }
    for (std::size_t e = 0; e < 6; ++e)
        part.bezier[4 + e] =
            2 * part.bezier[4 + e] - (part.bezier[tet_edges[e][0]] + part.bezier[tet_edges[e][1]]) / 2;
    const auto [lower, upper] = hull(degree, top, bottom);
    part.lower = lower;
    part.upper = upper;
    const auto value_of = [&](const BernsteinTable& of, std::size_t i) {
        double sum = 0;
        for (std::size_t k = 0; k < 10; ++k) sum += of.quadratic_weights(i)[k] * part.bezier[k];
        return sum;
    };
    if (bottom.empty()) {
        for (std::size_t i = 0; i < table.count(); ++i)
            part.error = std::max(part.error, std::abs(top[i] - value_of(table, i)));
        return part;
    }
    // (top - quadratic * bottom) / bottom, both of a degree that holds the product.
    const BernsteinTable& two = bernstein_table(2);
    const auto& terms = product_terms(degree, 2);
    const BernsteinTable& higher = bernstein_table(degree + 2);
    std::vector<double> above(higher.count()), below(higher.count());
    for (const ProductTerm& term : terms) {
        const double own = value_of(two, term.b);
        above[term.to] += term.weight * (top[term.a] - own * bottom[term.a]);
        below[term.to] += term.weight * bottom[term.a];
    }
    for (std::size_t i = 0; i < higher.count(); ++i)
        if (below[i] != 0) part.error = std::max(part.error, std::abs(above[i]) / below[i]);
    return part;
}

} // namespace isotet::linear
