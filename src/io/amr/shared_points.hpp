// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Points that boxes share, each once, with the cells around them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "grid/values/incidence.hpp"
#include "io/amr/lattice.hpp"
#include "io/amr/shown_cells.hpp"

namespace isotet::io::amr {

/// A box among those of all levels.
struct PlacedBox {
    std::size_t level = 0;
    CellBox box;
    std::uint64_t first_cell = 0, first_point = 0; ///< in arrays of all boxes, one behind the other
};

/// A point on an edge or a face of a larger cell, by its value there.
struct HangingPlace {
    std::uint64_t point = 0;
    std::size_t corners = 0; ///< 2 or 4
    std::array<std::uint64_t, 4> of{};
    std::array<double, 4> weights{};
};

/// The points of shown cells.
class SharedPoints {
public:
    static constexpr std::uint64_t none = std::numeric_limits<std::uint64_t>::max();

    /// `marks`   of each box: cells that are not shown
    SharedPoints(const Hierarchy& hierarchy, const Lattice& lattice, const std::vector<Marks>& marks);

    const std::vector<PlacedBox>& boxes() const { return boxes_; }
    std::size_t count() const { return numbers_.size(); }
    /// By place in arrays of points of all boxes; `none` where no shown cell has the point.
    std::uint64_t at(std::uint64_t box_point) const { return at_[box_point]; }
    /// The shown cells that have the point as a corner, ascending in arrays of all boxes.
    std::span<const std::uint64_t> cells_of(std::uint64_t point) { return around_->of(point); }
    std::size_t box_number_of(std::uint64_t cell) const;

    /// Points on edges and faces of larger shown cells; those that others depend on first.
    std::vector<HangingPlace> hanging();

private:
    std::optional<std::uint64_t> find(const Place& place) const;
    template <class Visit>
    void each_corner(std::uint64_t cell, const Visit& visit) const;
    void note_levels();

    friend class HangingFinder;

    const Lattice& lattice_;
    const std::vector<Marks>& marks_;
    std::vector<PlacedBox> boxes_;
    std::vector<std::uint64_t> numbers_; ///< in the lattice, ascending
    std::vector<std::uint64_t> at_;
    std::optional<core::Incidence<std::uint64_t>> around_;
    std::vector<std::uint8_t> mixed_; ///< of points: whether cells of several levels have them
};

} // namespace isotet::io::amr
