// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Marching tetrahedra: which triangles a tet gives, by which of its corners are above.
//
// A corner of a triangle lies on an active edge, written (corner above, corner below). Triangles are counter-clockwise
// seen from above, for an upright tet. A quadrilateral is cut from its vertex between the first above and the first
// below corner, so that a case and its complement have the same diagonal.
#pragma once

#include <array>
#include <cstdint>

namespace isotet::core {

struct ActiveEdge {
    std::uint8_t above = 0, below = 0; ///< corners of the tet, 0 to 3
};

struct TetCase {
    std::uint8_t edges = 0;              ///< active edges: 0, 3 or 4
    std::uint8_t triangles = 0;          ///< 0, 1 or 2: (0, 1, 2) and (0, 2, 3) of `polygon`
    std::array<ActiveEdge, 4> polygon{}; ///< the active edges, around; the fourth repeats the third when there are 3
};

/// Corner k of the triangle t is polygon[triangle_corners[t][k]].
inline constexpr std::uint8_t triangle_corners[2][3] = {{0, 1, 2}, {0, 2, 3}};

namespace detail {

constexpr std::array<TetCase, 16> make_case_table() {
    std::array<TetCase, 16> table{};
    for (unsigned index = 1; index < 15; ++index) {
        std::array<std::uint8_t, 4> above{}, below{};
        unsigned a = 0, b = 0;
        for (std::uint8_t corner = 0; corner < 4; ++corner) {
            if (index >> corner & 1) above[a++] = corner;
            else below[b++] = corner;
        }
        // Parity of the corners written as the lone one and the others, or the above ones and the below ones.
        std::array<std::uint8_t, 4> order{};
        const bool lone_below = b == 1;
        for (unsigned k = 0; k < 4; ++k)
            order[k] = lone_below ? (k == 0 ? below[0] : above[k - 1]) : (k < a ? above[k] : below[k - a]);
        bool odd = false;
        for (unsigned i = 0; i < 4; ++i)
            for (unsigned j = i + 1; j < 4; ++j) odd ^= order[i] > order[j];

        TetCase& c = table[index];
        if (a == 2) {
            const ActiveEdge first{above[0], below[0]}, other_above{above[1], below[0]}, opposite{above[1], below[1]},
                other_below{above[0], below[1]};
            c.edges = 4;
            c.triangles = 2;
            c.polygon = odd ? std::array{first, other_below, opposite, other_above}
                            : std::array{first, other_above, opposite, other_below};
        } else {
            std::array<ActiveEdge, 3> e{};
            for (unsigned k = 0; k < 3; ++k)
                e[k] = lone_below ? ActiveEdge{above[k], below[0]} : ActiveEdge{above[0], below[k]};
            const bool swap = lone_below == odd;
            c.edges = 3;
            c.triangles = 1;
            c.polygon = swap ? std::array{e[0], e[2], e[1], e[1]} : std::array{e[0], e[1], e[2], e[2]};
        }
    }
    return table;
}

} // namespace detail

/// By the sum over above corners k of 2^k.
inline constexpr std::array<TetCase, 16> case_table = detail::make_case_table();

} // namespace isotet::core
