// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where the corners of cells begin that follow one another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/grid.hpp>

namespace isotet::io {

/// Of linear cells, whose types say how many corners each has. Borrows the types.
class CellPlaces {
public:
    /// Nothing where a type is none of the contoured ones, vertex, line, triangle, pixel and quadrilateral. Uniform,
    /// and without types, where all are of one contoured type.
    static std::optional<CellPlaces> make(std::span<const std::uint8_t> types);
    /// Of `cells` cells of one contoured type.
    CellPlaces(CellType type, std::uint64_t cells);

    std::uint64_t cells() const { return cells_; }
    std::uint64_t corners() const { return begin(cells_); } ///< of all cells
    std::uint64_t begin(std::uint64_t cell) const;
    std::uint64_t cell_at(std::uint64_t corner) const; ///< the cell that has it
    bool are_uniform() const { return types_.empty(); }
    bool all_have_volumes() const;
    std::uint8_t type(std::uint64_t cell) const { return are_uniform() ? type_ : types_[cell]; }
    std::span<const std::uint8_t> types(std::uint64_t first, std::uint64_t count) const {
        return are_uniform() ? types_ : types_.subspan(first, count);
    }

private:
    explicit CellPlaces(std::span<const std::uint8_t> types) : cells_(types.size()), types_(types) {}

    std::uint64_t cells_;
    std::span<const std::uint8_t> types_; ///< empty: all are of one
    std::uint8_t type_ = 0;
    std::uint64_t uniform_corners_ = 0;
    std::vector<std::uint64_t> before_ = {}; ///< corners before every `stride`th cell
};

/// Their cells in a grid; `types` are empty where all are of one.
Cells cells_at(const CellPlaces& places, const Array& types, Array corners);

/// Cuts blocks of corners into whole cells, of which the corners may lie in several blocks.
class WholeCells {
public:
    /// Cells [first, first + count) and their corners, of the type of the block or as uint64.
    using Visit = std::function<void(std::uint64_t first, std::uint64_t count, const Array& corners)>;

    /// Borrows the places.
    WholeCells(const CellPlaces& places, Visit visit) : places_(places), visit_(std::move(visit)) {}

    /// Corners from place `first` on. Safe from many threads.
    void add(std::uint64_t first, const Array& corners);
    /// When all were added.
    void finish();

private:
    struct Fragment {
        std::uint64_t first;
        std::vector<std::uint64_t> corners;
    };

    void keep_fragment(std::uint64_t first, const Array& corners);

    const CellPlaces& places_;
    Visit visit_;
    std::mutex mutex_;
    std::vector<Fragment> fragments_; ///< under the mutex
};

} // namespace isotet::io
