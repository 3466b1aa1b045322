// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The arithmetic of the contract, operation by operation, each rounded once: every engine computes just this.
// Built with -ffp-contract=off; stored values (storage.hpp) keep every step away from denormals and overflow.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "numbers/normal_code.hpp"
#include "numbers/storage.hpp"

namespace isotet::core {

template <class Real>
using Vector = std::array<Real, 3>;

/// Where the isovalue lies between the end below (0) and the end above (1).
template <class Real>
Real edge_weight(const StoredIsovalue<Real>& isovalue, Real below, Real above) {
    const Real rounded_up = isovalue.value - below;
    const Real t = (rounded_up + isovalue.rest) / (above - below);
    return t < Real(0x1p-32) ? Real(0) : t;
}

/// a + t (b - a); exactly b at t = 1, which the formula alone can miss.
template <class Real>
Real interpolate(Real a, Real b, Real t) {
    if (t == Real(1)) return b;
    const Real difference = b - a;
    const Real part = t * difference;
    return a + part;
}

/// A point field at a vertex: NaN at an end gives the canonical NaN.
template <class Real>
Real interpolate_field(Real a, Real b, Real t) {
    if (is_nan(a) || is_nan(b)) return canonical_nan<Real>();
    return interpolate(a, b, t);
}

template <class Real>
Vector<Real> normalized(const Vector<Real>& v) {
    const Real xx = v[0] * v[0], yy = v[1] * v[1], zz = v[2] * v[2];
    const Real sum = xx + yy;
    const Real length = std::sqrt(sum + zz);
    return {v[0] / length, v[1] / length, v[2] / length};
}

/// The unit direction of a normal code; zero for zero_normal_code.
template <class Real>
Vector<Real> direction_of(std::uint32_t code) {
    const auto n = decode_normal(code);
    if (code == zero_normal_code) return {};
    return normalized(Vector<Real>{static_cast<Real>(n[0]), static_cast<Real>(n[1]), static_cast<Real>(n[2])});
}

/// The gradient normal at a vertex; zero when an end has none or they cancel (the face normal then stands in).
template <class Real>
Vector<Real> vertex_normal(std::uint32_t below, std::uint32_t above, Real t) {
    if (below == zero_normal_code || above == zero_normal_code) return {};
    const Vector<Real> a = direction_of<Real>(below), b = direction_of<Real>(above);
    Vector<Real> n;
    bool vanishes = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        n[axis] = interpolate(a[axis], b[axis], t);
        vanishes &= std::abs(n[axis]) < Real(0x1p-32);
    }
    if (vanishes) return {};
    return normalized(n);
}

/// Times the power of two that brings the largest component into [1, 2); what is then below 2^-40 becomes 0.
template <class Real>
Vector<Real> scaled_to_one(const Vector<Real>& v) {
    const Real largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
    if (largest == 0) return {};
    // Stored coordinates keep `largest` normal, so its exponent stands in its bits; times 2^-exponent is exact.
    using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
    constexpr int mantissa = std::numeric_limits<Real>::digits - 1;
    constexpr Bits bias = std::numeric_limits<Real>::max_exponent - 1;
    const Real factor = std::bit_cast<Real>((2 * bias - (std::bit_cast<Bits>(largest) >> mantissa)) << mantissa);
    Vector<Real> out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out[axis] = v[axis] * factor;
        if (std::abs(out[axis]) < Real(0x1p-40)) out[axis] = 0;
    }
    return out;
}

/// The unit normal of a triangle; (0, 0, 0) when its area is zero.
template <class Real>
Vector<Real> face_normal(const Vector<Real>& a, const Vector<Real>& b, const Vector<Real>& c) {
    const Vector<Real> u = scaled_to_one(Vector<Real>{b[0] - a[0], b[1] - a[1], b[2] - a[2]});
    const Vector<Real> v = scaled_to_one(Vector<Real>{c[0] - a[0], c[1] - a[1], c[2] - a[2]});
    Vector<Real> n;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
        const Real first = u[j] * v[k], second = u[k] * v[j];
        n[axis] = first - second;
    }
    n = scaled_to_one(n);
    if (n[0] == 0 && n[1] == 0 && n[2] == 0) return {};
    return normalized(n);
}

} // namespace isotet::core
