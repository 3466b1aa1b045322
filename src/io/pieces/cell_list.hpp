// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where readers put the cells of a file, one after another, whatever their types.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <isotet/grid.hpp>

namespace isotet::io {

/// Gathers cells. Point numbers take 32 bits where the grid has no more than 2^31 points; types and offsets are kept as
/// runs of cells of one type, and written out only if there is more than one type.
class CellList {
public:
    /// `points`   a number that every point number is below
    explicit CellList(std::uint64_t points) : wide_(points > (std::uint64_t{1} << 31U)) {}

    /// Room for so many more corners.
    void reserve(std::uint64_t corners) { wide_ ? reserve_in(wide_corners_, corners) : reserve_in(corners_, corners); }

    /// Starts a cell; `corners` calls of corner() must follow.
    void start(std::uint8_t vtk_type, std::uint32_t corners) {
        if (runs_.empty() || runs_.back().type != vtk_type || runs_.back().corners != corners) {
            runs_.push_back({vtk_type, corners, 0});
        }
        ++runs_.back().cells;
        ++cells_;
    }
    void corner(std::uint64_t point) {
        highest_ = std::max(highest_, point);
        if (wide_) wide_corners_.push_back(static_cast<std::int64_t>(point));
        else corners_.push_back(static_cast<std::int32_t>(point));
    }

    std::uint64_t size() const noexcept { return cells_; }
    /// The highest point number of all corners; 0 if there are none.
    std::uint64_t highest() const noexcept { return highest_; }

    /// The cells as a grid has them; the list is empty afterwards.
    Cells finish();

private:
    struct Run {
        std::uint8_t type;
        std::uint32_t corners;
        std::uint64_t cells;
    };

    /// Many small steps must not copy everything each time.
    template <class Index>
    static void reserve_in(std::vector<Index>& corners, std::uint64_t more) {
        const std::size_t needed = corners.size() + more, capacity = corners.capacity();
        if (needed > capacity) corners.reserve(std::max(needed, capacity + capacity / 2));
    }
    template <class Offset>
    Array offsets() const;
    bool one_contoured_type() const;

    bool wide_;
    std::uint64_t cells_ = 0;
    std::uint64_t highest_ = 0;
    std::vector<Run> runs_;
    std::vector<std::int32_t> corners_;
    std::vector<std::int64_t> wide_corners_;
};

} // namespace isotet::io
