// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The stages of packing, in the order in which they run, and what they hand on. docs/inside/packing.md draws them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>

#include "base/buffer.hpp"
#include "packed/build/cell_order.hpp"
#include "packed/packed.hpp"
#include "packed/set_field.hpp"

namespace isotet::core {

inline constexpr std::size_t clusters_per_task = 64; // of the stages that run over clusters

/// A point by the cluster that owns it and its place among that cluster's own points. Ordered as packed points are.
struct PointRef {
    std::uint64_t value;
    static PointRef make(std::uint32_t owner, std::uint8_t index) { return {std::uint64_t{owner} << 8 | index}; }
    std::uint32_t owner() const { return static_cast<std::uint32_t>(value >> 8); }
    std::uint8_t index() const { return static_cast<std::uint8_t>(value); }
};

/// A packed grid in the making: the parts of Packed that are final, and what later stages need beside them.
struct Draft {
    Packed packed;
    Buffer<std::uint64_t> first_local; ///< C + 1: where each cluster's local points start
    Buffer<std::uint64_t> locals;      ///< ranks first, PointRefs after number_points()
    Buffer<std::uint64_t> point_of;    ///< rank -> user's point

    std::size_t clusters() const { return packed.headers.size(); }
    std::size_t local_count(std::size_t cluster) const { return first_local[cluster + 1] - first_local[cluster]; }
};

/// How many blocks of cells are grown at the same time: all threads, but at most a fifth of the blocks, or four of
/// them, since growing takes some 45 bytes for each tet of a block, and 70 for each other cell, beside what the cells
/// themselves take.
std::size_t blocks_at_once(std::uint64_t cells);

/// Grows clusters block by block. Fills headers (cells, first_word, first_group), cells (corners as positions among the cluster's
/// points), first_local and locals; and cell ids when the origins are there.
/// `user_cells`   how many the user's grid has
template <class Item>
Result<void> form_clusters(CellOrder<Item> order, std::uint64_t user_cells, Draft& draft, const Progress& progress);

/// Gives every point its owner and packed number, and every cluster its local order. Fills headers (own and ghost
/// points, first_point) and point ids; turns locals into PointRefs and corners of cells into local indices.
void number_points(std::uint64_t user_points, Draft& draft);

/// Finds the edges that several clusters hold. Fills the rest of the headers, and links.
Result<void> link_clusters(Draft& draft, const Progress& progress);

/// Stores the coordinates; fills positions, origin and what of it goes into the report.
/// Errors   invalid_argument when they do not fit the frame
template <class Real>
Result<void> store_positions(const Array& points, Packed& packed);

} // namespace isotet::core
