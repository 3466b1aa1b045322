// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fields/expression/tensor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace isotet::core {

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix out{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t k = 0; k < 3; ++k) out[i][j] += a[i][k] * b[k][j];
    return out;
}

/// Makes entry (p, q) of a symmetric matrix zero by a rotation.
void rotate(Matrix& a, std::size_t p, std::size_t q) {
    if (a[p][q] == 0) return;
    const double theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
    const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
    const double c = 1 / std::sqrt(t * t + 1), s = t * c;
    for (std::size_t k = 0; k < 3; ++k) {
        const double kp = a[k][p], kq = a[k][q];
        a[k][p] = c * kp - s * kq;
        a[k][q] = s * kp + c * kq;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const double pk = a[p][k], qk = a[q][k];
        a[p][k] = c * pk - s * qk;
        a[q][k] = s * pk + c * qk;
    }
}

/// Of a symmetric matrix, by Jacobi's method: multiplications and roots alone, which round alike on every machine.
double middle_eigenvalue(Matrix a) {
    constexpr int sweeps = 8; // it converges quadratically
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        rotate(a, 0, 1);
        rotate(a, 0, 2);
        rotate(a, 1, 2);
    }
    const double x = a[0][0], y = a[1][1], z = a[2][2];
    return std::max(std::min(x, y), std::min(std::max(x, y), z));
}

bool has_nan(std::span<const double> values) {
    return std::ranges::any_of(values, [](double value) { return std::isnan(value); });
}

} // namespace

double q_criterion(std::span<const double> g) {
    return -0.5 * (g[0] * g[0] + g[4] * g[4] + g[8] * g[8]) - (g[1] * g[3] + g[2] * g[6] + g[5] * g[7]);
}

double lambda2(std::span<const double> g) {
    if (has_nan(g)) return std::numeric_limits<double>::quiet_NaN();
    Matrix symmetric{}, skew{};
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
            symmetric[i][j] = 0.5 * (g[3 * i + j] + g[3 * j + i]);
            skew[i][j] = 0.5 * (g[3 * i + j] - g[3 * j + i]);
        }
    Matrix sum = product(symmetric, symmetric);
    const Matrix turned = product(skew, skew);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) sum[i][j] += turned[i][j];
    return middle_eigenvalue(sum);
}

double von_mises(std::span<const double> s) {
    const bool whole = s.size() == 9;
    const double xx = s[0], yy = s[whole ? 4 : 1], zz = s[whole ? 8 : 2];
    const double xy = s[whole ? 1 : 3], yz = s[whole ? 5 : 4], xz = s[whole ? 2 : 5];
    const double normal = (xx - yy) * (xx - yy) + (yy - zz) * (yy - zz) + (zz - xx) * (zz - xx);
    return std::sqrt(0.5 * normal + 3 * (xy * xy + yz * yz + xz * xz));
}

} // namespace isotet::core
