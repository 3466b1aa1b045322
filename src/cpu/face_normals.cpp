// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The operations of core::face_normal() in the same order, sixteen triangles side by side without branches, so that the
// compiler makes SIMD code of them.
#include "cpu/face_normals.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "cpu/level.hpp"

namespace isotet::cpu {

namespace {

constexpr std::size_t lanes = 16;

template <class Real>
using Vectors = std::array<std::array<Real, lanes>, 3>; ///< by axis

/// core::scaled_to_one(). Zero stays zero: its factor is a power of two like any other.
template <class Real>
void scale_to_one(Vectors<Real>& v) {
    using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
    constexpr int mantissa = std::numeric_limits<Real>::digits - 1;
    constexpr Bits bias = std::numeric_limits<Real>::max_exponent - 1;
    for (std::size_t i = 0; i < lanes; ++i) {
        const Real x = std::abs(v[0][i]), y = std::abs(v[1][i]), z = std::abs(v[2][i]);
        const Real xy = x > y ? x : y, largest = xy > z ? xy : z;
        const Real factor = std::bit_cast<Real>((2 * bias - (std::bit_cast<Bits>(largest) >> mantissa)) << mantissa);
        const Real a = v[0][i] * factor, b = v[1][i] * factor, c = v[2][i] * factor;
        v[0][i] = std::abs(a) < Real(0x1p-40) ? Real(0) : a;
        v[1][i] = std::abs(b) < Real(0x1p-40) ? Real(0) : b;
        v[2][i] = std::abs(c) < Real(0x1p-40) ? Real(0) : c;
    }
}

template <class Real>
void cross(const Vectors<Real>& u, const Vectors<Real>& v, Vectors<Real>& out) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
        for (std::size_t i = 0; i < lanes; ++i) {
            const Real first = u[j][i] * v[k][i], second = u[k][i] * v[j][i];
            out[axis][i] = first - second;
        }
    }
}

/// Unit length; zero stays zero.
template <class Real>
void normalize(Vectors<Real>& v) {
    for (std::size_t i = 0; i < lanes; ++i) {
        const Real xx = v[0][i] * v[0][i], yy = v[1][i] * v[1][i], zz = v[2][i] * v[2][i];
        const Real sum = xx + yy;
        const Real length = std::sqrt(sum + zz);
        const Real divisor = length == 0 ? Real(1) : length; // the largest component is in [1, 2), or all are zero
        v[0][i] /= divisor;
        v[1][i] /= divisor;
        v[2][i] /= divisor;
    }
}

template <class Real, class Index>
void find(const Real* positions, const Index* triangles, std::size_t count, float* out) {
    for (std::size_t begin = 0; begin < count; begin += lanes) {
        const std::size_t some = std::min(lanes, count - begin);
        Vectors<Real> u{}, v{}, normal;
        for (std::size_t i = 0; i < some; ++i) {
            const Index* const triangle = triangles + 3 * (begin + i);
            const Real* const a = positions + 3 * static_cast<std::size_t>(triangle[0]);
            const Real* const b = positions + 3 * static_cast<std::size_t>(triangle[1]);
            const Real* const c = positions + 3 * static_cast<std::size_t>(triangle[2]);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                u[axis][i] = b[axis] - a[axis];
                v[axis][i] = c[axis] - a[axis];
            }
        }
        scale_to_one(u);
        scale_to_one(v);
        cross(u, v, normal);
        scale_to_one(normal);
        normalize(normal);
        for (std::size_t i = 0; i < some; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) *out++ = static_cast<float>(normal[axis][i]);
    }
}

#if defined(__x86_64__)
// Everything is inlined into these, and so compiled for their instruction set.
template <class Real, class Index>
[[gnu::target("avx512f,avx512bw,avx512vl"), gnu::flatten]] void
find_avx512(const Real* positions, const Index* triangles, std::size_t count, float* out) {
    find(positions, triangles, count, out);
}
template <class Real, class Index>
[[gnu::target("avx2"), gnu::flatten]] void find_avx2(const Real* positions, const Index* triangles, std::size_t count,
                                                     float* out) {
    find(positions, triangles, count, out);
}
#endif

} // namespace

template <class Real, class Index>
void face_normals(const Real* positions, const Index* triangles, std::size_t count, float* out) {
    switch (level()) {
#if defined(__x86_64__)
    case Level::avx512: return find_avx512(positions, triangles, count, out);
    case Level::avx2: return find_avx2(positions, triangles, count, out);
#endif
    default: return find(positions, triangles, count, out);
    }
}

template void face_normals<float, std::uint32_t>(const float*, const std::uint32_t*, std::size_t, float*);
template void face_normals<float, std::uint64_t>(const float*, const std::uint64_t*, std::size_t, float*);
template void face_normals<double, std::uint32_t>(const double*, const std::uint32_t*, std::size_t, float*);
template void face_normals<double, std::uint64_t>(const double*, const std::uint64_t*, std::size_t, float*);

} // namespace isotet::cpu
