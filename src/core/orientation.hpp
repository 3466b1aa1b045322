// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Tets as they are stored: upright, corners in canonical order (design: contract, points 5 and 7).
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>

#include <isotet/grid.hpp>

#include "core/cells.hpp"
#include "core/exact.hpp"

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
inline Tet canonical(Tet t) {
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
/// file; it is mirrored when most tetrahedra of the grid are, and a flat piece of a split cell when its cell is.
class Orienter {
public:
    Orienter(const Array& points, bool mostly_negative) : points_(points), mostly_negative_(mostly_negative) {}

    struct Counts {
        std::uint64_t negative = 0, flat = 0;
    };

    /// Orients and canonicalizes the tets of one cell in place; adds to `counts`. Pieces of a split cell count as
    /// negative when their sign is not that of their cell.
    void orient(std::uint8_t cell_type, CellTets& tets, Counts& counts) const {
        const bool whole = cell_type == static_cast<std::uint8_t>(CellType::tetrahedron);
        bool cell_negative = mostly_negative_;
        if (!whole) {
            double volume = 0;
            for (const Tet& t : tets) volume += points_.six_volumes(t);
            cell_negative = volume < 0;
        }
        for (int i = 0; i < tets.count; ++i) {
            Tet& t = tets.tets[static_cast<std::size_t>(i)];
            const int sign = points_.orientation(t);
            counts.flat += sign == 0;
            counts.negative += whole ? sign < 0 : sign != 0 && (sign < 0) != cell_negative;
            if (sign < 0 || (sign == 0 && cell_negative)) std::swap(t[2], t[3]);
            t = canonical(t);
        }
    }

private:
    PointReader points_;
    bool mostly_negative_;
};

/// True when more tetrahedra of the grid (cells of that type) have a negative volume than a positive one. Parallel.
bool mostly_negative(const Grid& grid, const CellReader& cells);

} // namespace isotet::core
