// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/own_functions.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "linear/curved/curved_kinds.hpp"

namespace isotet::linear {

namespace {

/// The inverse of a square matrix, by rows.
std::vector<double> inverse_of(std::vector<long double> matrix, std::size_t n) {
    std::vector<long double> inverse(n * n, 0);
    for (std::size_t i = 0; i < n; ++i) inverse[i * n + i] = 1;
    for (std::size_t column = 0; column < n; ++column) {
        std::size_t pivot = column;
        for (std::size_t row = column; row < n; ++row)
            if (std::abs(matrix[row * n + column]) > std::abs(matrix[pivot * n + column])) pivot = row;
        for (std::size_t k = 0; k < n; ++k) {
            std::swap(matrix[pivot * n + k], matrix[column * n + k]);
            std::swap(inverse[pivot * n + k], inverse[column * n + k]);
        }
        const long double scale = 1 / matrix[column * n + column];
        for (std::size_t k = 0; k < n; ++k) {
            matrix[column * n + k] *= scale;
            inverse[column * n + k] *= scale;
        }
        for (std::size_t row = 0; row < n; ++row) {
            const long double times = matrix[row * n + column];
            if (row == column || times == 0) continue;
            for (std::size_t k = 0; k < n; ++k) {
                matrix[row * n + k] -= times * matrix[column * n + k];
                inverse[row * n + k] -= times * inverse[column * n + k];
            }
        }
    }
    return {inverse.begin(), inverse.end()};
}

long double bernstein_value(const std::array<std::uint8_t, 4>& index, std::size_t count,
                            const std::array<std::uint8_t, 4>& at, unsigned degree) {
    long double value = 1;
    unsigned chosen = 0;
    for (std::size_t k = 0; k < count; ++k)
        for (unsigned m = 1; m <= index[k]; ++m)
            value *= static_cast<long double>(++chosen) / m * at[k] / static_cast<long double>(degree);
    return value;
}

/// Of a node of a simplex; `at` over `steps` is where, both are barycentric.
double lagrange_weight(std::span<const std::int64_t> node, std::span<const std::int64_t> at, std::int64_t degree,
                       std::int64_t steps) {
    double value = 1;
    for (std::size_t k = 0; k < node.size(); ++k)
        for (std::int64_t m = 0; m < node[k]; ++m)
            value *= static_cast<double>(degree * at[k] - m * steps) /
                     (static_cast<double>(node[k] - m) * static_cast<double>(steps));
    return value;
}

double bezier_weight(std::span<const std::int64_t> node, std::span<const std::int64_t> at, std::int64_t steps) {
    double value = 1;
    double chosen = 0;
    for (std::size_t k = 0; k < node.size(); ++k)
        for (std::int64_t m = 1; m <= node[k]; ++m)
            value *= ++chosen / static_cast<double>(m) * static_cast<double>(at[k]) / static_cast<double>(steps);
    return value;
}

/// The factor's coordinates of a place: barycentric, over the steps. A pyramid's lines have others.
std::vector<std::int64_t> barycentric(core::CellKind kind, std::size_t factor, const std::array<std::int64_t, 3>& at,
                                      std::int64_t steps) {
    if (kind == core::CellKind::tetrahedron) return {steps - at[0] - at[1] - at[2], at[0], at[1], at[2]};
    if (kind == core::CellKind::wedge && factor == 0) return {steps - at[0] - at[1], at[0], at[1]};
    const std::size_t axis = kind == core::CellKind::wedge ? 2 : factor;
    return {steps - at[axis], at[axis]};
}

} // namespace

OwnFunctions::Factor OwnFunctions::factor_of(std::size_t dimension) const {
    Factor out{dimension, {}, {}};
    const unsigned p = kind_.degree;
    const auto add = [&](unsigned a, unsigned b, unsigned c) {
        out.indices.push_back({static_cast<std::uint8_t>(p - a - b - c), static_cast<std::uint8_t>(a),
                               static_cast<std::uint8_t>(b), static_cast<std::uint8_t>(c)});
    };
    for (unsigned a = 0; a <= p; ++a)
        for (unsigned b = 0; a + b <= (dimension > 1 ? p : a); ++b)
            for (unsigned c = 0; a + b + c <= (dimension > 2 ? p : a + b); ++c) add(a, b, c);
    const std::size_t n = out.indices.size();
    std::vector<long double> values(n * n);
    for (std::size_t at = 0; at < n; ++at)
        for (std::size_t i = 0; i < n; ++i)
            values[at * n + i] = bernstein_value(out.indices[i], dimension + 1, out.indices[at], p);
    out.to_bernstein = inverse_of(std::move(values), n);
    return out;
}

/// The place where a lattice point of the factors lies.
CellPlace OwnFunctions::grid_place(std::size_t at) const {
    std::array<std::array<std::int64_t, 4>, 3> index{};
    for (std::size_t f = factors_.size(); f-- > 0;) {
        const auto& indices = factors_[f].indices;
        std::ranges::copy(indices[at % indices.size()], index[f].begin());
        at /= indices.size();
    }
    const std::int64_t p = kind_.degree;
    switch (kind_.kind) {
    case core::CellKind::tetrahedron: return {{index[0][1], index[0][2], index[0][3]}, p};
    case core::CellKind::wedge: return {{index[0][1], index[0][2], index[1][1]}, p};
    case core::CellKind::pyramid:
        return {{index[0][1] * (p - index[2][1]), index[1][1] * (p - index[2][1]), index[2][1] * p}, p * p};
    case core::CellKind::hexahedron: break;
    }
    return {{index[0][1], index[1][1], index[2][1]}, p};
}

/// From values at the lattice points of all factors to Bernstein coefficients.
void OwnFunctions::apply_factors(std::vector<double>& values, std::size_t columns) const {
    std::vector<double> next(values.size());
    std::size_t inner = columns;
    for (std::size_t f = factors_.size(); f-- > 0;) {
        const std::size_t n = factors_[f].indices.size(), outer = values.size() / (n * inner);
        std::ranges::fill(next, 0);
        for (std::size_t o = 0; o < outer; ++o)
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t k = 0; k < n; ++k) {
                    const double weight = factors_[f].to_bernstein[i * n + k];
                    if (weight == 0) continue;
                    for (std::size_t c = 0; c < inner; ++c)
                        next[(o * n + i) * inner + c] += weight * values[(o * n + k) * inner + c];
                }
        std::swap(values, next);
        inner *= n;
    }
}

OwnFunctions::OwnFunctions(const OwnKind& kind)
    : kind_(kind), nodes_(core::nodes_of_degree(kind.kind, kind.degree, core::NodeOrder::vtk)) {
    std::vector<std::size_t> dimensions{1, 1, 1};
    if (kind.kind == core::CellKind::tetrahedron) dimensions = {3};
    if (kind.kind == core::CellKind::wedge) dimensions = {2, 1};
    for (const std::size_t dimension : dimensions) {
        factors_.push_back(factor_of(dimension));
        net_size_ *= factors_.back().indices.size();
    }
    if (is_rational()) pyramid_.emplace(kind.degree);
    const std::size_t count = nodes_.size();
    to_net_.resize(net_size_ * count);
    std::vector<double> weights, squares(net_size_ * 10);
    for (std::size_t at = 0; at < net_size_; ++at) {
        const CellPlace place = grid_place(at);
        std::array<double, 4> x{1, 0, 0, 0};
        for (std::size_t k = 0; k < 3; ++k)
            x[k + 1] = static_cast<double>(place.at[k]) / static_cast<double>(place.steps);
        for (std::size_t a = 0, to = 0; a < 4; ++a)
            for (std::size_t b = a; b < 4; ++b) squares[at * 10 + to++] = x[a] * x[b];
        if (kind.of == OwnKind::Of::bezier) continue;
        this->weights(place, weights);
        std::ranges::copy(weights, to_net_.begin() + static_cast<std::ptrdiff_t>(at * count));
    }
    if (kind.of == OwnKind::Of::bezier) { // nodes are the net
        for (std::size_t at = 0; at < net_size_; ++at)
            for (std::size_t i = 0; i < count; ++i) {
                const auto& [x, y, z] = nodes_[i];
                to_net_[at * count + i] = grid_place(at).at == std::array<std::int64_t, 3>{x, y, z} ? 1 : 0;
            }
    } else {
        apply_factors(to_net_, count);
    }
    for (std::size_t at = 0; at < net_size_; ++at) {
        double sum = 0;
        for (std::size_t i = 0; i < count; ++i) sum += std::abs(to_net_[at * count + i]);
        net_norm_ = std::max(net_norm_, sum);
    }
    apply_factors(squares, 10);
    quadratics_ = std::move(squares);
    for (std::size_t k = 0; k < 10; ++k) // Gram and Schmidt, twice for its rounding
        for (int again = 0; again < 2; ++again) {
            for (std::size_t l = 0; l < k; ++l) {
                double product = 0;
                for (std::size_t i = 0; i < net_size_; ++i)
                    product += quadratics_[i * 10 + k] * quadratics_[i * 10 + l];
                for (std::size_t i = 0; i < net_size_; ++i)
                    quadratics_[i * 10 + k] -= product * quadratics_[i * 10 + l];
            }
            double square = 0;
            for (std::size_t i = 0; i < net_size_; ++i) square += quadratics_[i * 10 + k] * quadratics_[i * 10 + k];
            for (std::size_t i = 0; i < net_size_; ++i) quadratics_[i * 10 + k] /= std::sqrt(square);
        }
}

void OwnFunctions::weights(const CellPlace& place, std::vector<double>& out) const {
    out.assign(nodes_.size(), 0);
    const std::int64_t p = kind_.degree;
    if (is_rational()) {
        std::array<long double, 3> at{};
        for (std::size_t k = 0; k < 3; ++k)
            at[k] = static_cast<long double>(place.at[k]) / static_cast<long double>(place.steps);
        const std::int64_t width = place.steps - place.at[2];
        out = pyramid_->at(at);
        const auto is_beside = [&](const core::LatticePlace& n) { // on a face without the node
            for (std::size_t axis = 0; axis < 2; ++axis) {
                if (place.at[axis] == 0 && n[axis] != 0) return true;
                if (place.at[axis] == width && n[axis] + n[2] != p) return true;
            }
            return place.at[2] == 0 && n[2] != 0;
        };
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            if (is_beside(nodes_[i])) out[i] = 0;
        return;
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        double weight = 1;
        for (std::size_t f = 0; f < factors_.size(); ++f) {
            const auto node = barycentric(kind_.kind, f, {nodes_[i][0], nodes_[i][1], nodes_[i][2]}, p);
            const auto at = barycentric(kind_.kind, f, place.at, place.steps);
            weight *= kind_.of == OwnKind::Of::bezier ? bezier_weight(node, at, place.steps)
                                                      : lagrange_weight(node, at, p, place.steps);
        }
        out[i] = weight;
    }
}

void OwnFunctions::net(std::span<const double> values, std::vector<double>& out) const {
    out.assign(net_size_, 0);
    const std::size_t count = nodes_.size();
    const double first = values[0]; // equal values have an equal net
    for (std::size_t at = 0; at < net_size_; ++at) {
        double sum = 0;
        for (std::size_t i = 1; i < count; ++i) sum += to_net_[at * count + i] * (values[i] - first);
        out[at] = first + sum;
    }
}

double OwnFunctions::error_at_most(std::span<const double> net) const {
    std::array<double, 10> part{};
    for (std::size_t i = 0; i < net_size_; ++i)
        for (std::size_t k = 0; k < 10; ++k) part[k] += quadratics_[i * 10 + k] * net[i];
    double largest = 0;
    for (std::size_t i = 0; i < net_size_; ++i) {
        double rest = net[i];
        for (std::size_t k = 0; k < 10; ++k) rest -= quadratics_[i * 10 + k] * part[k];
        if (!(std::abs(rest) <= largest)) largest = std::abs(rest);
    }
    constexpr double lebesgue = 2.25; // of quadratic interpolation in a tet it is 2, in its middle
    return (1 + lebesgue) * largest;
}

/// Linear functions of the cell's coordinates of which the factor's Bernstein functions are products.
std::array<double, 4> OwnFunctions::forms(std::size_t factor, const CellPlace& at) const {
    const auto steps = static_cast<double>(at.steps);
    const auto& [x, y, z] = at.at;
    const auto over = [&](std::int64_t value) { return static_cast<double>(value) / steps; };
    if (is_rational() && factor < 2) return {over(at.steps - z - at.at[factor]), over(at.at[factor]), 0, 0};
    if (is_rational()) return {over(at.steps - z), over(z), 0, 0};
    std::array<double, 4> out{};
    const auto all = barycentric(kind_.kind, factor, at.at, at.steps);
    for (std::size_t k = 0; k < all.size(); ++k) out[k] = over(all[k]);
    return out;
}

/// The Bernstein coefficients on the tet of each function of a factor: [coefficient][function]. The function of index a is
/// the coefficient of t^a in the power of the sum of t_k times form k; polarized, that of a product over the corners.
std::vector<double> OwnFunctions::values_on_tet(std::size_t factor, const std::array<CellPlace, 4>& corners) const {
    const Factor& of = factors_[factor];
    const unsigned p = kind_.degree;
    const std::size_t n = of.indices.size(), side = p + 1;
    std::array<std::array<double, 4>, 4> form{};
    for (std::size_t c = 0; c < 4; ++c) form[c] = forms(factor, corners[c]);
    std::vector<std::size_t> number(side * side * side);
    for (std::size_t i = 0; i < n; ++i)
        number[(of.indices[i][1] * side + of.indices[i][2]) * side + of.indices[i][3]] = i;
    const BernsteinTable& table = bernstein_table(p);
    std::vector<double> out(table.count() * n, 0), product(side * side * side), next(product.size());
    for (std::size_t i = 0; i < table.count(); ++i) {
        std::ranges::fill(product, 0);
        product[0] = 1; // powers of t1, t2, t3; that of t0 is what is left
        for (std::size_t c = 0; c < 4; ++c)
            for (unsigned m = 0; m < table[i][c]; ++m) {
                std::ranges::fill(next, 0);
                for (std::size_t at = 0; at < product.size(); ++at) {
                    if (product[at] == 0) continue;
                    next[at] += form[c][0] * product[at];
                    std::size_t stride = side * side;
                    for (std::size_t k = 1; k <= of.dimension; ++k, stride /= side)
                        next[at + stride] += form[c][k] * product[at];
                }
                std::swap(product, next);
            }
        for (std::size_t k = 0; k < n; ++k)
            out[i * n + k] = product[(of.indices[k][1] * side + of.indices[k][2]) * side + of.indices[k][3]];
    }
    return out;
}

void OwnFunctions::on_tet(std::span<const double> net, const Tet& tet, std::vector<double>& out) const {
    std::vector<double> have(net.begin(), net.end()); // [coefficient so far][functions of the factors to come]
    const unsigned p = kind_.degree;
    std::size_t rest = net_size_;
    for (std::size_t f = 0; f < factors_.size(); ++f) {
        const std::size_t n = factors_[f].indices.size();
        rest /= n;
        const std::vector<double>& values = tet.factors[f];
        const std::size_t per = bernstein_table(p).count();
        const std::size_t before = have.size() / (n * rest);
        std::vector<double> partial(before * per * rest, 0);
        for (std::size_t k = 0; k < before; ++k)
            for (std::size_t j = 0; j < per; ++j)
                for (std::size_t i = 0; i < n; ++i) {
                    const double value = values[j * n + i];
                    if (value == 0) continue;
                    for (std::size_t r = 0; r < rest; ++r)
                        partial[(k * per + j) * rest + r] += value * have[(k * n + i) * rest + r];
                }
        if (f == 0) {
            have = std::move(partial);
            continue;
        }
        const unsigned so_far = static_cast<unsigned>(f) * p;
        std::vector<double> sum(bernstein_table(so_far + p).count() * rest, 0);
        for (const ProductTerm& term : product_terms(so_far, p))
            for (std::size_t r = 0; r < rest; ++r)
                sum[term.to * rest + r] += term.weight * partial[(term.a * per + term.b) * rest + r];
        have = std::move(sum);
    }
    out = std::move(have);
}

OwnFunctions::Tet OwnFunctions::tet(const std::array<CellPlace, 4>& corners) const {
    Tet out;
    for (std::size_t f = 0; f < factors_.size(); ++f) out.factors.push_back(values_on_tet(f, corners));
    if (!is_rational()) return out;
    const std::vector<double> ones(net_size_, 1);
    std::vector<double> bottom;
    on_tet(ones, out, bottom);
    out.bottom = std::move(bottom);
    return out;
}

const OwnFunctions& own_functions(const OwnKind& kind) {
    static std::mutex mutex;
    static std::map<OwnKind, std::unique_ptr<const OwnFunctions>> known;
    const std::lock_guard lock(mutex);
    auto& found = known[kind];
    if (!found) found = std::make_unique<const OwnFunctions>(kind);
    return *found;
}

} // namespace isotet::linear
