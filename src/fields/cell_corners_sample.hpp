// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Some cells of a grid, in runs, to tell fields from noise.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>

namespace isotet::core {

/// The cells of a grid of so many that a sample looks at, as ranges [first, last): in ascending order, and apart.
ISOTET_API std::vector<std::pair<std::uint64_t, std::uint64_t>> cells_to_sample(std::uint64_t cells);

/// Runs of consecutive cells spread over a grid, with the points of each. Nothing is assumed of the grid: what does not
/// fit is passed over.
class CellCornersSample {
public:
    /// `numbers`   of the cells, where the grid has only those that would be looked at (cells_to_sample()); else empty
    explicit CellCornersSample(const Grid& grid, std::span<const std::uint64_t> numbers = {});

    /// The variance of a scalar within cells (point fields), or around points (cell fields), as a share of that over
    /// all: about 1 for noise, far less for what varies over many cells. Values are magnitudes of vectors. 0 where the
    /// sample does not tell, or nothing varies.
    double roughness(const Array& values, Association association) const;

    /// The same of the coordinates, the largest of the three: what a linear field has on this grid.
    double roughness_of_linear_fields() const { return linear_; }

    /// False where none of the cells of the sample has a value, at its corners or its own.
    bool has_values(const Array& values, Association association) const;

    /// Whether the grid is one cell thick along an axis, and many along the others.
    bool is_one_cell_thick() const { return thin_; }

private:
    void measure_cells(const Array& points);

    /// Group g has the items first_[g] to first_[g + 1].
    struct Groups {
        std::vector<std::uint64_t> items;
        std::vector<std::size_t> first{0};
    };
    Groups points_of_cells_, cells_of_points_;
    double linear_ = 0;
    bool thin_ = false;
};

} // namespace isotet::core
