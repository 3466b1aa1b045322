// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How a cell becomes tets: the rule behind split_cell(), for callers that need not see all of them.
#pragma once

#include <algorithm>
#include <cstdint>

#include "grid/cell/cell_kind.hpp"

namespace isotet::core {

/// True when the diagonal of a quadrilateral face starts in its first corner (or third): when one of these is the lowest.
template <class Number>
constexpr bool is_cut_from_first(Number a, Number b, Number c, Number d) {
    return std::min(a, c) <= std::min(b, d);
}

/// Dompierre and others, 1999: every face is cut from its lowest corner. A tet stays as it is.
///
/// Calls sink.expect(count), and then sink.add(a, b, c, d) with positions of corners for each of the `count` tets, those with
/// repeated corners included.
template <class Number, class Sink>
class Splitter {
public:
    /// `numbers`   of the corners' points
    Splitter(const Number* numbers, Sink& sink) : numbers_(numbers), sink_(sink) {}

    void split(CellKind kind) {
        switch (kind) {
        case CellKind::tetrahedron:
            sink_.expect(1);
            sink_.add(0, 1, 2, 3);
            break;
        case CellKind::pyramid:
            sink_.expect(2);
            add_quad(0, 1, 2, 3, 4);
            break;
        case CellKind::wedge: split_wedge(); break;
        case CellKind::hexahedron: split_hexahedron(); break;
        }
    }

private:
    using Position = std::uint8_t;

    Number number(Position corner) const { return numbers_[corner]; }

    bool diagonal_from_first(Position a, Position b, Position c, Position d) const {
        return is_cut_from_first(number(a), number(b), number(c), number(d));
    }

    /// Two tets between the quadrilateral a b c d and a point.
    void add_quad(Position a, Position b, Position c, Position d, Position apex) {
        if (diagonal_from_first(a, b, c, d)) {
            sink_.add(a, b, c, apex);
            sink_.add(a, c, d, apex);
        } else {
            sink_.add(a, b, d, apex);
            sink_.add(b, c, d, apex);
        }
    }

    // The lowest corner sees the three faces that do not touch it; each of their halves makes a tet with it. If no
    // diagonal of these faces ends in the opposite corner 6, that corner is cut off and five tets are enough.
    void split_hexahedron() {
        // Rotations that bring corner k to position 0 (Dompierre and others, table 1).
        static constexpr Position rotations[8][8] = {
            {0, 1, 2, 3, 4, 5, 6, 7}, {1, 2, 3, 0, 5, 6, 7, 4}, {2, 3, 0, 1, 6, 7, 4, 5}, {3, 0, 1, 2, 7, 4, 5, 6},
            {4, 7, 6, 5, 0, 3, 2, 1}, {5, 4, 7, 6, 1, 0, 3, 2}, {6, 5, 4, 7, 2, 1, 0, 3}, {7, 6, 5, 4, 3, 2, 1, 0}};
        const Position* const v = rotations[std::min_element(numbers_, numbers_ + 8) - numbers_];
        const bool right = diagonal_from_first(v[1], v[5], v[6], v[2]); // 1-6
        const bool back = diagonal_from_first(v[3], v[2], v[6], v[7]);  // 3-6
        const bool top = diagonal_from_first(v[4], v[7], v[6], v[5]);   // 4-6
        if (!right && !back && !top) {
            sink_.expect(5);
            sink_.add(v[0], v[1], v[2], v[5]);
            sink_.add(v[0], v[2], v[3], v[7]);
            sink_.add(v[0], v[5], v[7], v[4]);
            sink_.add(v[2], v[7], v[5], v[6]);
            sink_.add(v[0], v[2], v[7], v[5]);
            return;
        }
        sink_.expect(6);
        // Faces counter-clockwise seen from corner 0, so that every tet is as upright as the cell.
        add_quad(v[1], v[5], v[6], v[2], v[0]);
        add_quad(v[3], v[2], v[6], v[7], v[0]);
        add_quad(v[4], v[7], v[6], v[5], v[0]);
    }

    void split_wedge() {
        static constexpr Position rotations[6][6] = {{0, 1, 2, 3, 4, 5}, {1, 2, 0, 4, 5, 3}, {2, 0, 1, 5, 3, 4},
                                                     {3, 5, 4, 0, 2, 1}, {4, 3, 5, 1, 0, 2}, {5, 4, 3, 2, 1, 0}};
        const Position* const v = rotations[std::min_element(numbers_, numbers_ + 6) - numbers_];
        sink_.expect(3);
        sink_.add(v[3], v[4], v[5], v[0]); // VTK's wedges have their first triangle outward: so these are upright
        add_quad(v[1], v[2], v[5], v[4], v[0]);
    }

    const Number* numbers_;
    Sink& sink_;
};

} // namespace isotet::core
