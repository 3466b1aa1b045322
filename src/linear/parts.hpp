// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Linear cells in the making: blocks of the user's cells are done side by side, then put together.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <isotet/linear_cells.hpp>

#include "base/buffer.hpp"
#include "grid/cell_survey.hpp"
#include "grid/cells.hpp"

namespace isotet::linear {

/// What a block of cells becomes, while it grows. A corner with the highest bit set is derived point `corner - derived_bit`
/// of the block.
class Parts {
public:
    static constexpr std::uint64_t derived_bit = core::MadeCells::made_bit;

    LinearizeReport report;

    /// `source`   the user's cell, ascending
    void add_cell(std::uint8_t type, std::span<const std::uint64_t> corners, std::uint64_t source);
    /// A cell that stays as it is.
    void keep_cell(const core::CellReader& cells, std::size_t cell);
    /// Returns the corner that means it.
    std::uint64_t add_point(std::span<const std::uint64_t> points, std::span<const double> weights);

    std::span<const std::uint8_t> types() const { return types_; }
    std::span<const std::uint32_t> corner_counts() const { return corner_counts_; }
    std::span<const std::uint64_t> corners() const { return corners_; }
    std::size_t rows() const { return term_counts_.size(); } ///< derived points
    /// Of derived points, one after another: `use(points, weights)`; the weights are one number where all are alike.
    template <class Use>
    void for_rows(const Use& use) const {
        std::size_t term = 0, weight = 0;
        for (std::size_t row = 0; row < term_counts_.size(); ++row) {
            const std::size_t count = term_counts_[row];
            const std::size_t weights = alike_[row] ? std::min<std::size_t>(count, 1) : count;
            use(std::span(term_points_).subspan(term, count), std::span(term_weights_).subspan(weight, weights));
            term += count;
            weight += weights;
        }
    }
    /// Keeps the memory.
    void clear();

private:
    friend class KeptParts;

    void add_source(std::uint64_t source);

    std::vector<std::uint64_t> corners_;
    std::vector<std::uint32_t> corner_counts_; ///< of cells
    std::vector<std::uint8_t> types_;
    std::vector<std::uint64_t> sources_;     ///< users' cells
    std::vector<std::uint32_t> part_counts_; ///< and how many cells each became
    std::vector<std::uint32_t> term_counts_; ///< of derived points
    std::vector<std::uint64_t> term_points_;
    std::vector<std::uint8_t> alike_; ///< of derived points: whether all weights are one number, which then stands once
    std::vector<double> term_weights_;
};

/// The same in arrays of its size.
class KeptParts {
public:
    KeptParts() = default;
    /// Empties `parts`, which keep their memory for the next block.
    ///
    /// `narrow`   point numbers are kept in 32 bits: there are fewer points than 2^31
    KeptParts(Parts& parts, bool narrow);

private:
    friend class PartsJoiner;

    core::Buffer<std::uint32_t> narrow_corners_; ///< with the highest bit likewise
    core::Buffer<std::uint64_t> wide_corners_;
    core::Buffer<std::uint32_t> corner_counts_, part_counts_, term_counts_;
    core::Buffer<std::uint8_t> types_, alike_;
    core::Buffer<std::uint64_t> sources_;
    core::Buffer<std::uint32_t> narrow_terms_;
    core::Buffer<std::uint64_t> wide_terms_;
    core::Buffer<double> term_weights_;
    LinearizeReport report_;
};

/// The blocks in their order; takes them apart. Sets cells, points' weights, sources and the report, not the points.
LinearGrid joined(std::vector<KeptParts>& blocks, std::uint64_t user_points);

} // namespace isotet::linear
