// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// core::vertex_normal() for many vertices: the same operations in the same order, side by side without branches, so
// that a compiler makes SIMD code of them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "numbers/normal_code.hpp"

namespace isotet::cpu {

/// Gradient normals of vertices, sixteen at a time.
template <class Real>
class VertexNormals {
public:
    static constexpr std::size_t lanes = 16;
    using Codes = std::array<std::uint32_t, lanes>; ///< normal_code.hpp
    using Lanes = std::array<Real, lanes>;

    std::array<Lanes, 3> normal; ///< zero where the face normal stands in

    void compute(const Codes& below, const Codes& above, const Lanes& weight) {
        std::array<Lanes, 3> a, b;
        directions(below, a);
        directions(above, b);
        Lanes largest{};
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t i = 0; i < lanes; ++i) {
                const Real difference = b[axis][i] - a[axis][i];
                const Real part = weight[i] * difference;
                const Real between = a[axis][i] + part;
                normal[axis][i] = weight[i] == Real(1) ? b[axis][i] : between;
                const Real magnitude = std::abs(normal[axis][i]);
                largest[i] = magnitude > largest[i] ? magnitude : largest[i];
            }
        normalize(normal);
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (std::size_t i = 0; i < lanes; ++i) {
                const bool no_below = below[i] == core::zero_normal_code, no_above = above[i] == core::zero_normal_code,
                           vanishes = largest[i] < Real(0x1p-32);
                normal[axis][i] = (no_below | no_above | vanishes) ? Real(0) : normal[axis][i];
            }
    }

private:
    static void directions(const Codes& codes, std::array<Lanes, 3>& out) {
        for (std::size_t i = 0; i < lanes; ++i) {
            const int u = static_cast<std::int16_t>(codes[i] & 0xffff), v = static_cast<std::int16_t>(codes[i] >> 16);
            const int abs_u = u < 0 ? -u : u, abs_v = v < 0 ? -v : v;
            const int z = core::normal_code_steps - abs_u - abs_v;
            const int folded_u = core::normal_code_steps - abs_v, folded_v = core::normal_code_steps - abs_u;
            out[0][i] = static_cast<Real>(z >= 0 ? u : u < 0 ? -folded_u : folded_u);
            out[1][i] = static_cast<Real>(z >= 0 ? v : v < 0 ? -folded_v : folded_v);
            out[2][i] = static_cast<Real>(z);
        }
        normalize(out);
    }

    static void normalize(std::array<Lanes, 3>& v) {
        for (std::size_t i = 0; i < lanes; ++i) {
            const Real xx = v[0][i] * v[0][i], yy = v[1][i] * v[1][i], zz = v[2][i] * v[2][i];
            const Real sum = xx + yy;
            const Real length = std::sqrt(sum + zz);
            v[0][i] /= length;
            v[1][i] /= length;
            v[2][i] /= length;
        }
    }
};

} // namespace isotet::cpu
