// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The arithmetic on a batch of active tets: corners sorted, cases, signs of volumes. Plain loops over rows, which the
// compiler turns into vectors of whatever the caller is compiled for; nothing depends on which.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace isotet::cpu::direct {

/// What is known of a tet with its corners ascending.
namespace tet_code {
constexpr std::uint8_t case_mask = 0x0f; ///< bit k: corner k is above
constexpr std::uint8_t negative = 0x10;  ///< the sign of its volume
constexpr std::uint8_t unsure = 0x20;    ///< the sign needs exact arithmetic
constexpr std::uint8_t collapsed = 0x40; ///< two corners are the same
constexpr std::uint8_t special = 0x80;   ///< a corner is tied or without data
constexpr std::uint8_t unusual = unsure | collapsed | special;
} // namespace tet_code

template <class Row>
inline void order_rows(Row& low, Row& high, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto a = low[i], b = high[i];
        low[i] = a < b ? a : b;
        high[i] = a < b ? b : a;
    }
}

/// Sorts the corners of `count` tets, rows of doubled points plus side, and adds case and `collapsed` to their codes.
template <class Rows, class Codes>
inline void sort_corners(Rows& rows, Codes& codes, std::size_t count) {
    for (const auto& [low, high] : {std::pair{0, 1}, {2, 3}, {0, 2}, {1, 3}, {1, 2}})
        order_rows(rows[static_cast<std::size_t>(low)], rows[static_cast<std::size_t>(high)], count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto a = rows[0][i], b = rows[1][i], c = rows[2][i], d = rows[3][i];
        const bool same = ((a ^ b) < 2) | ((b ^ c) < 2) | ((c ^ d) < 2);
        codes[i] |= static_cast<std::uint8_t>((a & 1) | (b & 1) << 1 | (c & 1) << 2 | (d & 1) << 3 |
                                              (same ? tet_code::collapsed : 0));
    }
}

/// Adds the sign of the volume, or that it is not sure: the filter of core::orientation_sign().
/// `xyz`  [corner][axis][tet]
template <class Coordinates, class Codes>
inline void sign_volumes(const Coordinates& xyz, Codes& codes, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto at = [&](std::size_t corner, std::size_t axis) { return static_cast<double>(xyz[corner][axis][i]); };
        const double ax = at(0, 0), ay = at(0, 1), az = at(0, 2);
        const double bx = at(1, 0) - ax, by = at(1, 1) - ay, bz = at(1, 2) - az;
        const double cx = at(2, 0) - ax, cy = at(2, 1) - ay, cz = at(2, 2) - az;
        const double dx = at(3, 0) - ax, dy = at(3, 1) - ay, dz = at(3, 2) - az;
        const double determinant = bx * (cy * dz - cz * dy) + by * (cz * dx - cx * dz) + bz * (cx * dy - cy * dx);
        const double permanent = (std::abs(cy * dz) + std::abs(cz * dy)) * std::abs(bx) +
                                 (std::abs(cz * dx) + std::abs(cx * dz)) * std::abs(by) +
                                 (std::abs(cx * dy) + std::abs(cy * dx)) * std::abs(bz);
        constexpr double epsilon = 0x1p-53;
        const double bound = (7.0 + 56.0 * epsilon) * epsilon * permanent;
        const bool sure = (std::abs(determinant) > bound) & (bound > 0x1p-900);
        codes[i] |=
            static_cast<std::uint8_t>((determinant < 0 ? tet_code::negative : 0) | (sure ? 0 : tet_code::unsure));
    }
}

/// Adds the signs of the volumes of tets to their codes; sign_volumes().
/// `corners`   rows of doubled points plus side
template <class Point, std::size_t batch, class Coordinate>
inline void sign_tets(const std::array<std::array<Point, batch>, 4>& corners, std::array<std::uint8_t, batch>& codes,
                      std::size_t count, const Coordinate* coordinates) {
    alignas(64) std::array<std::array<std::array<Coordinate, batch>, 3>, 4> xyz; // [corner][axis][tet]
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t i = 0; i < count; ++i) {
            const Coordinate* const p = coordinates + 3 * static_cast<std::size_t>(corners[k][i] >> 1);
            for (std::size_t axis = 0; axis < 3; ++axis) xyz[k][axis][i] = p[axis];
        }
    sign_volumes(xyz, codes, count);
}

} // namespace isotet::cpu::direct
