// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Tets as they are stored: upright, corners in canonical order (design: contract, points 5 and 7).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include <isotet/grid.hpp>

#include "base/prefetch.hpp"
#include "grid/cells.hpp"
#include "numbers/exact.hpp"

namespace isotet::core {

/// Reads points of either type as doubles.
class PointReader {
public:
    PointReader() = default;
    explicit PointReader(const Array& points) : data_(points.data()), single_(points.type() == ScalarType::float32) {}

    Point operator[](std::uint64_t i) const {
        if (single_) {
            const float* p = static_cast<const float*>(data_) + 3 * i;
            return {p[0], p[1], p[2]};
        }
        const double* p = static_cast<const double*>(data_) + 3 * i;
        return {p[0], p[1], p[2]};
    }
    /// Asks for a point that will be wanted soon.
    void prefetch(std::uint64_t i) const {
        core::prefetch(static_cast<const std::byte*>(data_) + 3 * i * (single_ ? sizeof(float) : sizeof(double)));
    }
    int orientation(const Tet& t) const {
        return orientation_sign((*this)[t[0]], (*this)[t[1]], (*this)[t[2]], (*this)[t[3]]);
    }
    double six_volumes(const Tet& t) const {
        return core::six_volumes((*this)[t[0]], (*this)[t[1]], (*this)[t[2]], (*this)[t[3]]);
    }

private:
    const void* data_ = nullptr;
    bool single_ = true;
};

/// Turns the corners without changing the orientation until the lowest comes first and the lowest of the others second.
template <class Corner>
std::array<Corner, 4> canonical(std::array<Corner, 4> t) {
    const auto swap_pairs = [&t](std::size_t a, std::size_t b, std::size_t c, std::size_t d) {
        std::swap(t[a], t[b]);
        std::swap(t[c], t[d]);
    };
    const auto lowest = std::min_element(t.begin(), t.end()) - t.begin();
    if (lowest == 1) swap_pairs(0, 1, 2, 3);
    else if (lowest == 2) swap_pairs(0, 2, 1, 3);
    else if (lowest == 3) swap_pairs(0, 3, 1, 2);
    // Rotate the last three.
    if (t[2] < t[1] && t[2] < t[3]) t = {t[0], t[2], t[3], t[1]};
    else if (t[3] < t[1] && t[3] < t[2]) t = {t[0], t[3], t[1], t[2]};
    return t;
}

/// Gives the tets of cells their stored form.
///
/// A tet of negative volume (exact sign on the user's coordinates) is mirrored. A flat tet keeps the orientation of the
/// file; it is mirrored when most tetrahedra of the grid are, and a flat piece of a split cell when its cell is. Tets of
/// ordered types (cells.hpp) stay as they are.
class Orienter {
public:
    Orienter(const Array& points, bool mostly_negative) : points_(points), mostly_negative_(mostly_negative) {}

    struct Counts {
        std::uint64_t upright = 0, negative = 0, flat = 0; ///< of tetrahedra
        std::uint64_t twisted = 0; ///< pieces of split cells whose sign is not that of their cell; flat pieces count as
                                   ///< flat

        /// Counts a tet by the sign of its volume. Returns whether its stored form is the mirrored one.
        /// `mirrored`   what a flat one is: as most tetrahedra, or as the cell of which it is a piece
        bool add(int sign, bool whole, bool mirrored) {
            if (sign == 0) ++flat;
            else if (whole) ++(sign < 0 ? negative : upright);
            else if ((sign < 0) != mirrored) ++twisted;
            return sign < 0 || (sign == 0 && mirrored);
        }
        /// Counts one that stays as it is, whatever its sign.
        void add_ordered(int sign) { add(sign, false, false); }
        /// Tetrahedra whose sign is not that of most, and twisted pieces.
        std::uint64_t inverted(bool mostly_negative) const { return (mostly_negative ? upright : negative) + twisted; }

        void combine(const Counts& other) {
            upright += other.upright;
            negative += other.negative;
            flat += other.flat;
            twisted += other.twisted;
        }
    };

    /// The stored form of one of a cell's tets; adds to `counts`.
    Tet stored(std::uint8_t cell_type, const CellTets& cell, unsigned piece, Counts& counts) const {
        return stored(cell_type, cell, cell.tets[piece], counts);
    }
    /// Of a tet to which a cell with these tets has collapsed, or of one of them.
    Tet stored(std::uint8_t cell_type, const CellTets& cell, Tet t, Counts& counts) const {
        if (is_ordered(cell_type)) {
            counts.add_ordered(points_.orientation(t));
            return canonical(t);
        }
        const bool whole = is_whole(cell_type);
        const bool mirrored = whole ? mostly_negative_ : six_volumes(points_, cell) < 0;
        if (counts.add(points_.orientation(t), whole, mirrored)) std::swap(t[2], t[3]);
        return canonical(t);
    }

    static bool is_whole(std::uint8_t cell_type) {
        return cell_type == static_cast<std::uint8_t>(CellType::tetrahedron);
    }

    /// Six times the volume of a split cell, rounded.
    static double six_volumes(const PointReader& points, const CellTets& cell) {
        double sum = 0;
        for (const Tet& t : cell) sum += points.six_volumes(t);
        return sum;
    }

    /// Tetrahedra whose sign is not that of most, and twisted pieces.
    std::uint64_t inverted(const Counts& counts) const { return counts.inverted(mostly_negative_); }

private:
    PointReader points_;
    bool mostly_negative_;
};

} // namespace isotet::core
