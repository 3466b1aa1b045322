// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/split.hpp"

#include <algorithm>

namespace isotet::core {

namespace {

/// The tets of one cell in the making, by positions of its corners.
class Splitter {
public:
    explicit Splitter(const WholeCell& cell) : numbers_(cell.corners.data()) {}

    LocalTets split(CellKind kind) {
        switch (kind) {
        case CellKind::tetrahedron: add(0, 1, 2, 3); break;
        case CellKind::pyramid: add_quad(0, 1, 2, 3, 4); break;
        case CellKind::wedge: split_wedge(); break;
        case CellKind::hexahedron: split_hexahedron(); break;
        }
        return out_;
    }

private:
    using Position = std::uint8_t;

    std::uint64_t number(Position corner) const { return numbers_[corner]; }

    void add(Position a, Position b, Position c, Position d) {
        const std::uint64_t p = number(a), q = number(b), r = number(c), s = number(d);
        if (p == q || p == r || p == s || q == r || q == s || r == s) ++out_.collapsed;
        else out_.tets[static_cast<std::size_t>(out_.count++)] = {a, b, c, d};
    }

    /// True when the diagonal of the quadrilateral a b c d starts in a (or c): when one of these is the lowest.
    bool diagonal_from_first(Position a, Position b, Position c, Position d) const {
        return std::min(number(a), number(c)) <= std::min(number(b), number(d));
    }

    /// Two tets between the quadrilateral a b c d and a point.
    void add_quad(Position a, Position b, Position c, Position d, Position apex) {
        if (diagonal_from_first(a, b, c, d)) {
            add(a, b, c, apex);
            add(a, c, d, apex);
        } else {
            add(a, b, d, apex);
            add(b, c, d, apex);
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
            add(v[0], v[1], v[2], v[5]);
            add(v[0], v[2], v[3], v[7]);
            add(v[0], v[5], v[7], v[4]);
            add(v[2], v[7], v[5], v[6]);
            add(v[0], v[2], v[7], v[5]);
            return;
        }
        // Faces counter-clockwise seen from corner 0, so that every tet is as upright as the cell.
        add_quad(v[1], v[5], v[6], v[2], v[0]);
        add_quad(v[3], v[2], v[6], v[7], v[0]);
        add_quad(v[4], v[7], v[6], v[5], v[0]);
    }

    void split_wedge() {
        static constexpr Position rotations[6][6] = {{0, 1, 2, 3, 4, 5}, {1, 2, 0, 4, 5, 3}, {2, 0, 1, 5, 3, 4},
                                                     {3, 5, 4, 0, 2, 1}, {4, 3, 5, 1, 0, 2}, {5, 4, 3, 2, 1, 0}};
        const Position* const v = rotations[std::min_element(numbers_, numbers_ + 6) - numbers_];
        add(v[3], v[4], v[5], v[0]); // VTK's wedges have their first triangle outward: so these are upright
        add_quad(v[1], v[2], v[5], v[4], v[0]);
    }

    const std::uint64_t* numbers_;
    LocalTets out_;
};

} // namespace

LocalTets split_locally(const WholeCell& cell) { return Splitter(cell).split(cell.kind); }

CellTets split_cell(const WholeCell& cell) {
    const LocalTets local = split_locally(cell);
    CellTets out;
    out.count = local.count;
    out.collapsed = local.collapsed;
    for (int i = 0; i < local.count; ++i)
        for (std::size_t k = 0; k < 4; ++k)
            out.tets[static_cast<std::size_t>(i)][k] = cell.corners[local.tets[static_cast<std::size_t>(i)][k]];
    return out;
}

} // namespace isotet::core
